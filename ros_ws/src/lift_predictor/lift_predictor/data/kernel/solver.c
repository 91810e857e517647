// SPDX-FileCopyrightText: 2026 The lift monitor authors
// SPDX-License-Identifier: Apache-2.0
// The interior-point method of core/solvers/interior_point.py, step for step, without Python
// between the steps. That module is the readable reference; constants.py has the constants of
// both; tests compare the two.

#include <float.h>
#include <time.h>

enum { OPTIMAL, INFEASIBLE, ITERATION_LIMIT, TIME_LIMIT, STUCK, NOT_FINITE, CANCELLED };
enum { FILTER_CAPACITY = 512 };

struct settings {
    double tolerance, infeasible_violation, time_limit, barrier, bound_push, gradient_limit;
    int max_iterations, warm;
    const volatile int *stop;  // set by another thread that wants the work to end; or NULL
};

struct result {
    int status, iterations;
    double objective, primal, dual, complementarity;
};

// v = (free variables, slacks); all arrays of it have n_v elements.
struct solver {
    struct problem *p;
    struct settings set;
    int n, m, n_equal, n_slack, n_v, n_all;
    int *free, *equal, *unequal;
    const double *fixed;  // values of all variables, of which the free ones are replaced
    double objective_scale, *g_scale, *low, *high, *target;
    double mu, last_shift, start_time;
    int iterations, restorations, n_filter, n_short;
    double filter_theta[FILTER_CAPACITY], filter_phi[FILTER_CAPACITY], theta_largest, theta_small;
    // Iterate, step, second step (correction), derivatives at the iterate.
    double *v, *y, *zl, *zu, *dv, *dy, *dzl, *dzu;
    double objective, *g, *gradient, *jacobian, *equality;
    double *sigma, *residual, *residual2, *trial_v, *trial_rows, *barrier;
    double *row_work, *row_work2, *full, *full2, *free_work, *free_work2, *eq_work;
    double *matrix, *factor, *big, *inner, *schur;
    double convexify;
};

// As fmax and fmin, but without a call; a second argument that is not a number is taken.
static inline double larger(double a, double b) { return a > b ? a : b; }
static inline double smaller(double a, double b) { return a < b ? a : b; }

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

static int cancelled(const struct solver *s) { return s->set.stop && *s->set.stop; }

static int late(const struct solver *s) { return now() - s->start_time > s->set.time_limit; }

// ---- dense algebra (row-major) -------------------------------------------------------------

static double dot(const double *a, const double *b, int n) {
    vec sum = {0};
    int i = 0;
    for (; i + LANES <= n; i += LANES) {
        vec x, y;
        memcpy(&x, a + i, sizeof x), memcpy(&y, b + i, sizeof y);
        sum += x * y;
    }
    double total = 0.0;
    for (int l = 0; l < LANES; l++) total += sum[l];
    for (; i < n; i++) total += a[i] * b[i];
    return total;
}

// Upper Cholesky factor of a + shift * 1, of which the upper triangle is read; 0 if there is none.
static int cholesky(const double *a, double shift, double *factor, int n) {
    enum { WIDE = 4 * LANES };
    for (int k = 0; k < n; k++) {
        double *row = factor + (size_t)k * n;
        // The row less all rows above: as many columns at once as fit the processor's registers.
        for (int j = k; j < n; j += WIDE) {
            int count = n - j < WIDE ? n - j : WIDE;
            if (count == WIDE) {
                vec sum[4];
                memcpy(sum, a + (size_t)k * n + j, sizeof sum);
                for (int i = 0; i < k; i++) {
                    const double *above = factor + (size_t)i * n;
                    vec other[4], share = spread(above[k]);
                    memcpy(other, above + j, sizeof other);
#pragma GCC unroll 4
                    for (int v = 0; v < 4; v++) sum[v] -= share * other[v];
                }
                memcpy(row + j, sum, sizeof sum);
            } else {
                memcpy(row + j, a + (size_t)k * n + j, count * sizeof(double));
                for (int i = 0; i < k; i++) {
                    const double *above = factor + (size_t)i * n;
                    for (int c = 0; c < count; c++) row[j + c] -= above[k] * above[j + c];
                }
            }
        }
        double pivot = row[k] + shift;
        if (!(pivot > 0.0) || !isfinite(pivot)) return 0;
        double scale = 1.0 / sqrt(pivot);
        for (int j = k + 1; j < n; j++) row[j] *= scale;
        row[k] = scale;  // the diagonal is kept inverted
    }
    return 1;
}

static void back_substitute(const double *restrict factor, double *restrict x, int n) {
    for (int i = 0; i < n; i++) {
        const double *row = factor + (size_t)i * n;
        double value = x[i] *= row[i];
        for (int j = i + 1; j < n; j++) x[j] -= row[j] * value;
    }
    for (int i = n - 1; i >= 0; i--) {
        const double *row = factor + (size_t)i * n;
        x[i] = (x[i] - dot(row + i + 1, x + i + 1, n - i - 1)) * row[i];
    }
}

static double largest(const double *a, int n) {
    double most = 0.0;
    for (int i = 0; i < n; i++) {
        double size = fabs(a[i]);
        if (!(size <= most)) most = size;  // also takes what is not a number
    }
    return most;
}

// ---- the problem, scaled and without fixed variables --------------------------------------

static const double *complete(struct solver *s, const double *x) {
    memcpy(s->full, s->fixed, s->n_all * sizeof(double));
    for (int i = 0; i < s->n; i++) s->full[s->free[i]] = x[i];
    return s->full;
}

static void scale_rows(const struct solver *s, double *g) {
    for (int k = 0; k < s->n_equal; k++) g[s->equal[k]] *= s->g_scale[s->equal[k]];
}

static double scaled_values(struct solver *s, const double *x, double *g) {
    double f = lift_values(s->p, complete(s, x), g);
    scale_rows(s, g);
    return s->objective_scale * f;
}

static void linearise(struct solver *s, const double *x) {
    s->objective = s->objective_scale * lift_first(s->p, complete(s, x), s->g, s->full2);
    scale_rows(s, s->g);
    for (int i = 0; i < s->n; i++) s->gradient[i] = s->objective_scale * s->full2[s->free[i]];
    lift_dense_rows(s->p, s->equal, s->n_equal, s->jacobian);
    for (int k = 0; k < s->n_equal; k++)
        for (int i = 0; i < s->n; i++)
            s->equality[(size_t)k * s->n + i] =
                s->g_scale[s->equal[k]] * s->jacobian[(size_t)k * s->n_all + s->free[i]];
}

static void jacobian_times(struct solver *s, const double *step, double *g) {
    memset(s->full, 0, s->n_all * sizeof(double));
    for (int i = 0; i < s->n; i++) s->full[s->free[i]] = step[i];
    lift_times(s->p, s->full, g);
    scale_rows(s, g);
}

// Overwrites the multipliers with scaled ones and scales them back.
static void jacobian_transposed(struct solver *s, const double *multiplier, double *out) {
    memcpy(s->row_work2, multiplier, s->m * sizeof(double));
    scale_rows(s, s->row_work2);
    lift_transposed(s->p, s->row_work2, s->full2);
    for (int i = 0; i < s->n; i++) out[i] = s->full2[s->free[i]];
}

// Condensed matrix of the free variables, into s->matrix.
static void condensed(struct solver *s, double sigma, const double *multiplier,
                      const double *weight) {
    memcpy(s->row_work2, multiplier, s->m * sizeof(double));
    scale_rows(s, s->row_work2);
    double *out = s->n == s->n_all ? s->matrix : s->big;
    lift_condensed(s->p, sigma * s->objective_scale, s->row_work2, weight, out);
    if (out == s->matrix) return;
    for (int i = 0; i < s->n; i++)
        for (int j = 0; j < s->n; j++)
            s->matrix[(size_t)i * s->n + j] = out[(size_t)s->free[i] * s->n_all + s->free[j]];
}
