// SPDX-FileCopyrightText: 2026 The lift monitor authors
// SPDX-License-Identifier: Apache-2.0
// Interior-point method: feasibility restoration, iterations, entry.

// ---- feasibility restoration --------------------------------------------------------------------

static double violation_of(const struct solver *s, const double *g, double *out) {
    double sum = 0.0;
    for (int k = 0; k < s->n_equal; k++) out[s->equal[k]] = g[s->equal[k]] - s->target[k];
    for (int k = 0; k < s->n_slack; k++) {
        double value = g[s->unequal[k]];
        double nearest = smaller(larger(value, s->low[s->n + k]), s->high[s->n + k]);
        out[s->unequal[k]] = value - nearest;
    }
    for (int r = 0; r < s->m; r++) sum += out[r] * out[r];
    return 0.5 * sum;
}

// Reduce half the squared violation of the constraints; x in v. 1 if it has a minimum there.
static int restore(struct solver *s, double goal, int limit) {
    int n = s->n, stalled = 0, *held = (int *)s->eq_work;
    double damping = FIRST_DAMPING, *violation = s->residual, *x = s->v, *gradient = s->free_work;
    scaled_values(s, x, s->g);
    double value = violation_of(s, s->g, violation);
    while (limit-- > 0) {
        double most = largest(violation, s->m);
        if (most <= goal || late(s) || cancelled(s)) return 0;
        linearise(s, x);
        jacobian_transposed(s, violation, gradient);
        double steep = 0.0, sum = 0.0;
        for (int i = 0; i < n; i++) {
            held[i] = (x[i] <= s->low[i] && gradient[i] > 0.0) ||
                      (x[i] >= s->high[i] && gradient[i] < 0.0);
            if (!held[i]) steep = larger(steep, fabs(gradient[i])), sum += fabs(gradient[i]);
        }
        if (steep <= STATIONARY * larger(1.0, most) || sum <= LEAST_GRADIENT_RATIO * value) return 1;
        s->iterations++;
        for (int r = 0; r < s->m; r++)
            s->row_work[r] = violation[r] != 0.0 ? s->g_scale[r] * s->g_scale[r] : 0.0;
        condensed(s, 0.0, violation, s->row_work);
        double size = 1.0;
        for (int i = 0; i < n; i++) {
            if (held[i]) {
                for (int j = 0; j < n; j++)
                    s->matrix[(size_t)i * n + j] = s->matrix[(size_t)j * n + i] = 0.0;
                s->matrix[(size_t)i * n + i] = 1.0;
            }
            size = larger(size, fabs(s->matrix[(size_t)i * n + i]));
        }
        double after = value;
        for (;; damping *= DAMPING_GROWTH) {
            if (damping > LARGEST_DAMPING) return 1;
            if (!cholesky(s->matrix, damping * size, s->factor, n)) continue;
            for (int i = 0; i < n; i++) s->free_work2[i] = held[i] ? 0.0 : -gradient[i];
            back_substitute(s->factor, s->free_work2, n);
            for (int i = 0; i < n; i++)
                s->trial_v[i] = smaller(larger(x[i] + s->free_work2[i], s->low[i]), s->high[i]);
            scaled_values(s, s->trial_v, s->trial_rows);
            after = violation_of(s, s->trial_rows, s->row_work2);
            if (after < value) break;
        }
        stalled = value - after <= STALLED * value ? stalled + 1 : 0;
        memcpy(x, s->trial_v, n * sizeof(double));
        memcpy(violation, s->row_work2, s->m * sizeof(double));
        value = after;
        damping = larger(DAMPING_DECAY * damping, FIRST_DAMPING);
        if (stalled == STALLED_STEPS) return 1;
    }
    return 0;
}

// -1: go on.
static int leave_dead_end(struct solver *s) {
    struct errors e = measure(s);
    if (scaled_error(s, &e, 0.0) <= ACCEPTABLE_FACTOR * s->set.tolerance) return OPTIMAL;
    double theta = rows_residual(s, s->g, s->v, s->residual);
    if (theta <= s->set.tolerance || ++s->restorations > MAX_RESTORATIONS) return STUCK;
    filter_add(s, theta, barrier_objective(s, s->objective, s->v));
    int minimum = restore(s, RESTORED_FACTOR * s->set.infeasible_violation,
                          s->set.max_iterations - s->iterations);
    for (int i = 0; i < s->n; i++) s->v[i] = inside(s->v[i], s->low[i], s->high[i], RESTORED_PUSH);
    linearise(s, s->v);
    violation_of(s, s->g, s->residual);
    double most = largest(s->residual, s->m);
    slacks_from_rows(s, RESTORED_SLACK_PUSH);
    first_multipliers(s);
    if (minimum && most > s->set.infeasible_violation) return INFEASIBLE;
    return s->iterations >= s->set.max_iterations ? ITERATION_LIMIT : -1;
}

// ---- the method -------------------------------------------------------------------------------

static int iterate(struct solver *s) {
    if (!isfinite(s->objective) || !isfinite(largest(s->g, s->m))) return NOT_FINITE;
    for (;;) {
        struct errors e = measure(s);
        if (scaled_error(s, &e, 0.0) <= s->set.tolerance) return OPTIMAL;
        double least = 0.1 * s->set.tolerance;
        while (s->mu > least && scaled_error(s, &e, s->mu) <= KAPPA_EPSILON * s->mu) {
            s->mu = larger(least, smaller(KAPPA_MU * s->mu, pow(s->mu, THETA_MU)));
            s->n_filter = 0;
        }
        if (s->iterations >= s->set.max_iterations) return ITERATION_LIMIT;
        if (late(s)) return TIME_LIMIT;
        if (cancelled(s)) return CANCELLED;
        s->iterations++;
        if (!factorise(s)) return STUCK;
        newton_step(s, s->residual);
        if (!line_search(s) || (s->n_short == SHORT_STEPS && s->set.tolerance < e.primal)) {
            s->n_short = 0;
            int status = leave_dead_end(s);
            if (status >= 0) return status;
        }
    }
}

static void start(struct solver *s, const double *x0, const double *y, const double *z) {
    struct settings *set = &s->set;
    int n = s->n;
    lift_first(s->p, s->fixed, s->g, s->full2);
    double steep = 0.0;
    for (int i = 0; i < n; i++) steep = larger(steep, fabs(s->full2[s->free[i]]));
    s->objective_scale = steep > set->gradient_limit ? set->gradient_limit / steep : 1.0;
    lift_dense_rows(s->p, s->equal, s->n_equal, s->jacobian);
    for (int k = 0; k < s->n_equal; k++) {
        double most = set->gradient_limit;
        for (int i = 0; i < n; i++)
            most = larger(most, fabs(s->jacobian[(size_t)k * s->n_all + s->free[i]]));
        s->g_scale[s->equal[k]] = set->gradient_limit / most;
        s->target[k] *= s->g_scale[s->equal[k]];
    }
    for (int i = n; i < s->n_v; i++) {
        s->low[i] -= BOUND_RELAXATION * larger(1.0, fabs(s->low[i]));
        s->high[i] += BOUND_RELAXATION * larger(1.0, fabs(s->high[i]));
    }
    for (int i = 0; i < n; i++)
        s->v[i] = inside(x0[s->free[i]], s->low[i], s->high[i], set->bound_push);
    linearise(s, s->v);
    slacks_from_rows(s, set->bound_push);
    s->mu = set->barrier;
    first_multipliers(s);
    if (set->warm) {
        for (int r = 0; r < s->m; r++) s->y[r] = s->objective_scale * y[r] / s->g_scale[r];
        for (int i = 0; i < s->n_v; i++) {
            double bound = i < n ? s->objective_scale * z[s->free[i]] : s->y[s->unequal[i - n]];
            double low = s->v[i] - s->low[i], high = s->high[i] - s->v[i];
            s->zl[i] = isfinite(low) ? larger(-bound, s->mu / low) : 0.0;
            s->zu[i] = isfinite(high) ? larger(bound, s->mu / high) : 0.0;
        }
    }
    double theta = rows_residual(s, s->g, s->v, s->residual);
    s->theta_largest = LARGEST_FACTOR * larger(1.0, theta);
    s->theta_small = SMALL_FACTOR * larger(1.0, theta);
}

// Unscaled result; see Solution in solution.py.
static void finish(struct solver *s, const double *lower, const double *upper,
                   const double *g_lower, const double *g_upper, double *x, double *y,
                   double *z, struct result *out) {
    memcpy(x, complete(s, s->v), s->n_all * sizeof(double));
    for (int i = 0; i < s->n_all; i++) x[i] = smaller(larger(x[i], lower[i]), upper[i]);
    out->objective = lift_first(s->p, x, s->g, s->full);
    out->primal = 0.0;
    for (int r = 0; r < s->m; r++) {
        y[r] = s->g_scale[r] * s->y[r] / s->objective_scale;
        out->primal = larger(out->primal, larger(g_lower[r] - s->g[r], s->g[r] - g_upper[r]));
    }
    lift_transposed(s->p, y, s->full2);
    for (int i = 0; i < s->n_all; i++) z[i] = -(s->full[i] + s->full2[i]);
    out->dual = 0.0;
    for (int i = 0; i < s->n; i++) {
        int at = s->free[i];
        double bound = (s->zu[i] - s->zl[i]) / s->objective_scale;
        out->dual = larger(out->dual, fabs(bound - z[at]));
        z[at] = bound;
    }
    struct errors e = measure(s);
    out->complementarity = e.bounds ? larger(e.high_product, 0.0) / s->objective_scale : 0.0;
    out->iterations = s->iterations;
}

// Solve; x0 in x, multipliers of a warm start in y and z; results in the same. 1: no memory.
int lift_solve(struct problem *p, const double *lower, const double *upper,
               const double *g_lower, const double *g_upper, const struct settings *set,
               double *x, double *y, double *z, struct result *out) {
    struct solver s = {.p = p, .set = *set, .m = p->m, .n_all = p->n, .start_time = now()};
    int n_all = p->n, m = p->m, q = 0, n = 0;
    for (int i = 0; i < n_all; i++) n += lower[i] != upper[i];
    for (int r = 0; r < m; r++) q += g_lower[r] == g_upper[r];
    s.n = n, s.n_equal = q, s.n_slack = m - q, s.n_v = n + m - q;
    size_t n_v = s.n_v, square = (size_t)n * n, eq = (size_t)q * n_all;
    size_t work = (size_t)q * q > (size_t)n ? (size_t)q * q : (size_t)n;
    double **arrays[] = {
        &s.low, &s.high, &s.v, &s.zl, &s.zu, &s.dv, &s.dzl, &s.dzu, &s.sigma, &s.trial_v,
        &s.barrier,
        &s.g_scale, &s.y, &s.dy, &s.g, &s.residual, &s.residual2, &s.trial_rows,
        &s.row_work, &s.row_work2,
        &s.full, &s.full2, &s.gradient, &s.free_work, &s.free_work2,
        &s.jacobian, &s.equality, &s.inner,
        &s.matrix, &s.factor, &s.big, &s.schur, &s.eq_work, &s.target,
    };
    size_t sizes[sizeof arrays / sizeof *arrays], total = 0;
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) {
        sizes[k] = k < 11 ? n_v : k < 20 ? (size_t)m : k < 25 ? (size_t)n_all : k < 28 ? eq
                 : k < 30 ? square : k == 30 ? (size_t)n_all * n_all : k == 33 ? (size_t)q : work;
        sizes[k] = (sizes[k] + LANES) / LANES * LANES;
        total += sizes[k];
    }
    double *memory = room(total / LANES), *at = memory;
    int *indices = malloc((n_all + 2 * (size_t)m + 1) * sizeof *indices);
    double *fixed = malloc((n_all + 1) * sizeof *fixed);
    if (!memory || !indices || !fixed) {
        free(memory), free(indices), free(fixed);
        return 1;
    }
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; at += sizes[k++]) *arrays[k] = at;
    s.free = indices, s.equal = indices + n_all, s.unequal = s.equal + m, s.fixed = fixed;
    n = q = 0;
    for (int i = 0; i < n_all; i++) {
        fixed[i] = lower[i] == upper[i] ? lower[i] : x[i];
        if (lower[i] == upper[i]) continue;
        s.low[n] = lower[i], s.high[n] = upper[i], s.free[n++] = i;
    }
    for (int r = 0, k = 0; r < m; r++) {
        s.g_scale[r] = 1.0;
        if (g_lower[r] == g_upper[r]) {
            s.target[q] = g_lower[r], s.equal[q++] = r;
        } else {
            s.low[n + k] = g_lower[r], s.high[n + k] = g_upper[r], s.unequal[k++] = r;
        }
    }
    start(&s, x, y, z);
    out->status = iterate(&s);
    finish(&s, lower, upper, g_lower, g_upper, x, y, z, out);
    free(memory), free(indices), free(fixed);
    return 0;
}
