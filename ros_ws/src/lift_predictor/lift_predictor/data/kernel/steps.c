// SPDX-FileCopyrightText: 2026 The lift monitor authors
// SPDX-License-Identifier: Apache-2.0
// Interior-point method: start, Newton steps, line search with second-order correction.

// ---- start ------------------------------------------------------------------------------------

static double inside(double value, double low, double high, double push) {
    double width = isfinite(high - low) ? high - low : INFINITY;
    if (isfinite(low)) {
        double least = low + smaller(push * larger(1.0, fabs(low)), push * width);
        if (value < least) value = least;
    }
    if (isfinite(high)) {
        double most = high - smaller(push * larger(1.0, fabs(high)), push * width);
        if (value > most) value = most;
    }
    return value;
}

static void slacks_from_rows(struct solver *s, double push) {
    for (int k = 0; k < s->n_slack; k++) {
        int i = s->n + k;
        s->v[i] = inside(s->g[s->unequal[k]], s->low[i], s->high[i], push);
    }
}

static void first_multipliers(struct solver *s) {
    memset(s->y, 0, s->m * sizeof(double));
    for (int i = 0; i < s->n_v; i++) {
        s->zl[i] = smaller(s->mu / (s->v[i] - s->low[i]), LARGEST_FIRST_MULTIPLIER);
        s->zu[i] = smaller(s->mu / (s->high[i] - s->v[i]), LARGEST_FIRST_MULTIPLIER);
        if (i >= s->n) s->y[s->unequal[i - s->n]] = s->zu[i] - s->zl[i];
    }
}

// ---- steps ------------------------------------------------------------------------------------

static int factorise(struct solver *s) {
    int n = s->n;
    memset(s->row_work, 0, s->m * sizeof(double));
    for (int i = 0; i < s->n_v; i++) {
        s->sigma[i] = s->zl[i] / (s->v[i] - s->low[i]) + s->zu[i] / (s->high[i] - s->v[i]);
        if (i >= n) s->row_work[s->unequal[i - n]] = s->sigma[i];
    }
    condensed(s, 1.0, s->y, s->row_work);
    double trace = 0.0, squares = 0.0;
    for (int i = 0; i < n; i++) {
        s->matrix[(size_t)i * n + i] += s->sigma[i];
        trace += fabs(s->matrix[(size_t)i * n + i]);
    }
    if (!isfinite(trace)) return 0;
    squares = dot(s->equality, s->equality, s->n_equal * n);
    s->convexify = squares > 0.0 ? CONVEXIFICATION * larger(trace / n, 1.0) * s->n_equal / squares : 0.0;
    if (s->convexify > 0.0)
        for (int k = 0; k < s->n_equal; k++) {
            const double *row = s->equality + (size_t)k * n;
            for (int i = 0; i < n; i++) {
                double factor = s->convexify * row[i];
                if (factor != 0.0)
                    for (int j = i; j < n; j++) s->matrix[(size_t)i * n + j] += factor * row[j];
            }
        }
    if (!cholesky(s->matrix, 0.0, s->factor, n)) {
        int first = s->last_shift == 0.0;
        double shift = first ? FIRST_SHIFT : larger(LEAST_SHIFT, s->last_shift / SHIFT_DECAY);
        double growth = first ? FIRST_GROWTH : SHIFT_GROWTH;
        while (!cholesky(s->matrix, shift, s->factor, n)) {
            shift *= growth;
            if (!(shift < LARGEST_SHIFT)) return 0;
        }
        s->last_shift = shift;
    }
    int q = s->n_equal;
    if (!q) return 1;
    memcpy(s->inner, s->equality, (size_t)q * n * sizeof(double));
    for (int k = 0; k < q; k++) back_substitute(s->factor, s->inner + (size_t)k * n, n);
    double most = 1e-300;
    for (int k = 0; k < q; k++)
        for (int l = 0; l <= k; l++)
            s->eq_work[(size_t)l * q + k] =
                dot(s->equality + (size_t)k * n, s->inner + (size_t)l * n, n);
    for (int k = 0; k < q; k++) most = larger(most, fabs(s->eq_work[(size_t)k * q + k]));
    double shift = 0.0;
    while (!cholesky(s->eq_work, shift, s->schur, q)) {
        shift = shift == 0.0 ? EQUALITY_SHIFT * most : 10.0 * shift;
        if (!isfinite(shift)) return 0;
    }
    return 1;
}

// Newton step for the given residual of the constraints, into dv, dy, dzl, dzu.
static void newton_step(struct solver *s, const double *residual) {
    int n = s->n, q = s->n_equal;
    double *right = s->dv;
    memset(s->row_work, 0, s->m * sizeof(double));
    for (int i = 0; i < s->n_v; i++) {
        s->barrier[i] = s->mu / (s->high[i] - s->v[i]) - s->mu / (s->v[i] - s->low[i]);
        if (i >= n) {
            int r = s->unequal[i - n];
            s->row_work[r] = s->sigma[i] * residual[r] + s->barrier[i];
        }
    }
    jacobian_transposed(s, s->row_work, right);
    for (int i = 0; i < n; i++) right[i] = -(s->gradient[i] + s->barrier[i]) - right[i];
    for (int k = 0; k < q; k++) {
        double factor = s->convexify * residual[s->equal[k]];
        for (int i = 0; i < n; i++) right[i] -= factor * s->equality[(size_t)k * n + i];
    }
    back_substitute(s->factor, right, n);
    double *y_equal = s->eq_work;  // its matrix is factored by now
    for (int k = 0; k < q; k++)
        y_equal[k] = dot(s->equality + (size_t)k * n, right, n) + residual[s->equal[k]];
    if (q) back_substitute(s->schur, y_equal, q);
    for (int k = 0; k < q; k++) {
        for (int i = 0; i < n; i++) right[i] -= y_equal[k] * s->inner[(size_t)k * n + i];
        s->dy[s->equal[k]] = y_equal[k] - s->y[s->equal[k]];
    }
    jacobian_times(s, s->dv, s->row_work);
    for (int i = 0; i < s->n_v; i++) {
        if (i >= n) {
            int r = s->unequal[i - n];
            s->dv[i] = s->row_work[r] + residual[r];
            s->dy[r] = s->sigma[i] * s->dv[i] + s->barrier[i] - s->y[r];
        }
        double low = s->v[i] - s->low[i], high = s->high[i] - s->v[i];
        s->dzl[i] = s->mu / low - s->zl[i] - s->zl[i] / low * s->dv[i];
        s->dzu[i] = s->mu / high - s->zu[i] + s->zu[i] / high * s->dv[i];
    }
}

static double boundary(const struct solver *s) { return larger(TAU_LEAST, 1.0 - s->mu); }

static double longest_step(const struct solver *s) {
    double tau = boundary(s), most = tau;
    for (int i = 0; i < s->n_v; i++) {
        double low = -s->dv[i] / (s->v[i] - s->low[i]), high = s->dv[i] / (s->high[i] - s->v[i]);
        most = larger(most, larger(low, high));
    }
    return smaller(1.0, tau / most);
}

static void move(const struct solver *s, double alpha) {
    for (int i = 0; i < s->n_v; i++) s->trial_v[i] = s->v[i] + alpha * s->dv[i];
}

static void take(struct solver *s, double alpha) {
    double tau = boundary(s), most = tau;
    for (int i = 0; i < s->n_v; i++) {
        if (isfinite(s->low[i])) most = larger(most, -s->dzl[i] / s->zl[i]);
        if (isfinite(s->high[i])) most = larger(most, -s->dzu[i] / s->zu[i]);
    }
    double dual = smaller(1.0, tau / most);
    for (int i = 0; i < s->n_v; i++) {
        double low = s->trial_v[i] - s->low[i], high = s->high[i] - s->trial_v[i];
        s->v[i] = s->trial_v[i];
        s->zl[i] += dual * s->dzl[i];
        s->zu[i] += dual * s->dzu[i];
        s->zl[i] = smaller(larger(s->zl[i], s->mu / (KAPPA_SIGMA * low)), KAPPA_SIGMA * s->mu / low);
        s->zu[i] = smaller(larger(s->zu[i], s->mu / (KAPPA_SIGMA * high)), KAPPA_SIGMA * s->mu / high);
    }
    for (int r = 0; r < s->m; r++) s->y[r] += alpha * s->dy[r];
    linearise(s, s->v);
}

// Second-order correction; 1 if a corrected step was accepted (dv and trial_v hold it).
static int correct(struct solver *s, double alpha, double theta, double phi, double slope,
                   int *enter) {
    double before = theta;
    memcpy(s->residual2, s->residual, s->m * sizeof(double));
    for (int k = 0; k < SOC_LIMIT; k++) {
        rows_residual(s, s->trial_rows, s->trial_v, s->row_work2);
        for (int r = 0; r < s->m; r++) s->residual2[r] = alpha * s->residual2[r] + s->row_work2[r];
        if (!isfinite(largest(s->residual2, s->m))) return 0;
        newton_step(s, s->residual2);
        double length = longest_step(s);
        move(s, length);
        double f = scaled_values(s, s->trial_v, s->trial_rows);
        double after = rows_residual(s, s->trial_rows, s->trial_v, s->row_work2);
        if (judge(s, theta, phi, after, barrier_objective(s, f, s->trial_v), slope, alpha, enter))
            return 1;
        if (!(after <= KAPPA_SOC * before)) return 0;
        before = after, alpha = length;
    }
    return 0;
}

static int line_search(struct solver *s) {
    double slope = 0.0, theta = rows_residual(s, s->g, s->v, s->residual);
    double phi = barrier_objective(s, s->objective, s->v);
    int tiny = 1;
    for (int i = 0; i < s->n_v; i++) {
        slope += s->barrier[i] * s->dv[i];
        if (i < s->n) slope += s->gradient[i] * s->dv[i];
        if (!(fabs(s->dv[i]) <= TINY * (1.0 + fabs(s->v[i])))) tiny = 0;
    }
    double first = longest_step(s);
    s->n_short = first < SHORT_STEP ? s->n_short + 1 : 0;
    double least = least_step(s, theta, slope);
    if (tiny) {
        move(s, first);
        take(s, first);
        return 1;
    }
    for (double alpha = first; alpha >= least; alpha *= 0.5) {
        move(s, alpha);
        double f = scaled_values(s, s->trial_v, s->trial_rows);
        double trial_theta = rows_residual(s, s->trial_rows, s->trial_v, s->row_work2);
        double trial_phi = barrier_objective(s, f, s->trial_v);
        int enter, accepted = judge(s, theta, phi, trial_theta, trial_phi, slope, alpha, &enter);
        if (!accepted && alpha == first && trial_theta >= theta) {
            accepted = correct(s, alpha, theta, phi, slope, &enter);
            if (!accepted) newton_step(s, s->residual);  // the step that was corrected
        }
        if (accepted) {
            if (enter) filter_add(s, theta, phi);
            take(s, alpha);
            return 1;
        }
    }
    return 0;
}
