// SPDX-FileCopyrightText: 2026 The lift monitor authors
// SPDX-License-Identifier: Apache-2.0
// Interior-point method: errors, barrier objective, filter.

// ---- measures of the iterate ----------------------------------------------------------------

static double rows_residual(const struct solver *s, const double *g, const double *v,
                            double *out) {
    double sum = 0.0;
    for (int k = 0; k < s->n_equal; k++) {
        int r = s->equal[k];
        out[r] = g[r] - s->target[k];
        sum += fabs(out[r]);
    }
    for (int k = 0; k < s->n_slack; k++) {
        int r = s->unequal[k];
        out[r] = g[r] - v[s->n + k];
        sum += fabs(out[r]);
    }
    return sum;
}

// Barrier objective: logarithms of products, as few as can be taken without overflow.
static double barrier_objective(const struct solver *s, double f, const double *v) {
    double sum = 0.0, product = 1.0;
    for (int i = 0; i < s->n_v; i++) {
        double low = v[i] - s->low[i], high = s->high[i] - v[i];
        if (isfinite(low)) product *= low;
        if (product < 1e-100 || product > 1e100) sum += log(product), product = 1.0;
        if (isfinite(high)) product *= high;
        if (product < 1e-100 || product > 1e100) sum += log(product), product = 1.0;
    }
    return f - s->mu * (sum + log(product));
}

struct errors { double primal, dual, sum_y, sum_z, low_product, high_product; int bounds; };

static struct errors measure(struct solver *s) {
    struct errors e = {0};
    e.low_product = DBL_MAX, e.high_product = -DBL_MAX;
    rows_residual(s, s->g, s->v, s->residual);
    e.primal = largest(s->residual, s->m);
    jacobian_transposed(s, s->y, s->free_work);
    for (int i = 0; i < s->n_v; i++) {
        double d = i < s->n ? s->gradient[i] + s->free_work[i] : -s->y[s->unequal[i - s->n]];
        d = fabs(d + s->zu[i] - s->zl[i]);
        if (!(d <= e.dual)) e.dual = d;
        double low = s->v[i] - s->low[i], high = s->high[i] - s->v[i];
        if (isfinite(low)) {
            double product = low * s->zl[i];
            if (product < e.low_product) e.low_product = product;
            if (product > e.high_product) e.high_product = product;
            e.bounds++;
        }
        if (isfinite(high)) {
            double product = high * s->zu[i];
            if (product < e.low_product) e.low_product = product;
            if (product > e.high_product) e.high_product = product;
            e.bounds++;
        }
        e.sum_z += s->zl[i] + s->zu[i];
    }
    for (int r = 0; r < s->m; r++) e.sum_y += fabs(s->y[r]);
    return e;
}

static double scaled_error(const struct solver *s, const struct errors *e, double mu) {
    double complementarity =
        e->bounds ? larger(e->high_product - mu, mu - e->low_product) : 0.0;
    int count = s->m + e->bounds;
    double s_d = larger(MULTIPLIER_SCALE, (e->sum_y + e->sum_z) / (count ? count : 1));
    double s_c = larger(MULTIPLIER_SCALE, e->sum_z / (e->bounds ? e->bounds : 1));
    double most = e->primal;
    double dual = MULTIPLIER_SCALE * e->dual / s_d;
    double product = MULTIPLIER_SCALE * complementarity / s_c;
    if (!(dual <= most)) most = dual;
    if (!(product <= most)) most = product;
    return most;
}

// ---- filter -----------------------------------------------------------------------------------

static int filter_accepts(const struct solver *s, double theta, double phi) {
    if (!(theta <= s->theta_largest)) return 0;
    for (int i = 0; i < s->n_filter; i++)
        if (!(theta < s->filter_theta[i] || phi < s->filter_phi[i])) return 0;
    return 1;
}

static void filter_add(struct solver *s, double theta, double phi) {
    if (s->n_filter == FILTER_CAPACITY) {  // forget the oldest
        memmove(s->filter_theta, s->filter_theta + 1, (FILTER_CAPACITY - 1) * sizeof(double));
        memmove(s->filter_phi, s->filter_phi + 1, (FILTER_CAPACITY - 1) * sizeof(double));
        s->n_filter--;
    }
    s->filter_theta[s->n_filter] = (1.0 - GAMMA_THETA) * theta;
    s->filter_phi[s->n_filter++] = phi - GAMMA_PHI * theta;
}

static int judge(const struct solver *s, double theta, double phi, double trial_theta,
                 double trial_phi, double slope, double step, int *enter) {
    *enter = 0;
    if (!filter_accepts(s, trial_theta, trial_phi)) return 0;
    double rounding = ROUNDING * larger(1.0, fabs(phi));
    int switching = slope < 0.0 && step * pow(-slope, S_PHI) > pow(theta, S_THETA);
    int armijo = trial_phi <= phi + ETA_PHI * step * slope + rounding;
    if (theta <= s->theta_small && switching) return armijo;
    int better = trial_theta <= (1.0 - GAMMA_THETA) * theta ||
                 trial_phi <= phi - GAMMA_PHI * theta + rounding;
    *enter = better && !(switching && armijo);
    return better;
}

static double least_step(const struct solver *s, double theta, double slope) {
    double bound = GAMMA_THETA;
    if (slope < 0.0) {
        bound = smaller(bound, GAMMA_PHI * theta / -slope);
        if (theta <= s->theta_small)
            bound = smaller(bound, pow(theta, S_THETA) / pow(-slope, S_PHI));
    }
    return GAMMA_ALPHA * bound;
}
