// SPDX-FileCopyrightText: 2026 The lift monitor authors
// SPDX-License-Identifier: Apache-2.0
// The interior-point method of core/solvers/interior_point.py, step for step, without Python
// between the steps. That module is the readable reference (and says where the constants come
// from); tests compare the two.

#include <float.h>
#include <time.h>

enum { OPTIMAL, INFEASIBLE, ITERATION_LIMIT, TIME_LIMIT, STUCK, NOT_FINITE };
enum { FILTER_ROOM = 512, SOC_LIMIT = 4, MAX_RESTORATIONS = 8 };

struct settings {
    double tolerance, infeasible_violation, time_limit, barrier, bound_push, gradient_limit;
    int max_iterations, warm;
};

struct outcome {
    int status, iterations;
    double objective, primal, dual, complementarity;
};

// v = (free variables, slacks); all arrays of it have n_v elements.
struct solver {
    struct programme *p;
    struct settings set;
    int n, m, n_equal, n_slack, n_v, n_all;
    int *free, *equal, *unequal;
    const double *fixed;  // values of all variables, of which the free ones are replaced
    double objective_scale, *row_scale, *low, *high, *target;
    double mu, last_shift, start_time;
    int iterations, restorations, n_filter, n_short;
    double filter_theta[FILTER_ROOM], filter_phi[FILTER_ROOM], theta_largest, theta_small;
    // Iterate, step, second step (correction), derivatives at the iterate.
    double *v, *y, *zl, *zu, *dv, *dy, *dzl, *dzu;
    double objective, *rows, *gradient, *jacobian, *equality;
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

// Lower Cholesky factor of a + shift * 1; 0 if it does not exist.
static int cholesky(const double *a, double shift, double *factor, int n) {
    for (int i = 0; i < n; i++) {
        double *row = factor + (size_t)i * n;
        for (int j = 0; j < i; j++) {
            const double *other = factor + (size_t)j * n;
            row[j] = (a[(size_t)i * n + j] - dot(row, other, j)) * other[j];
        }
        double pivot = a[(size_t)i * n + i] + shift - dot(row, row, i);
        if (!(pivot > 0.0) || !isfinite(pivot)) return 0;
        row[i] = 1.0 / sqrt(pivot);  // the diagonal is kept inverted
    }
    return 1;
}

static void back_substitute(const double *factor, double *x, int n) {
    for (int i = 0; i < n; i++) {
        const double *row = factor + (size_t)i * n;
        x[i] = (x[i] - dot(row, x, i)) * row[i];
    }
    for (int i = n - 1; i >= 0; i--) {
        const double *row = factor + (size_t)i * n;
        x[i] *= row[i];
        for (int j = 0; j < i; j++) x[j] -= row[j] * x[i];
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

// ---- the programme, scaled and without fixed variables --------------------------------------

static const double *complete(struct solver *s, const double *x) {
    memcpy(s->full, s->fixed, s->n_all * sizeof(double));
    for (int i = 0; i < s->n; i++) s->full[s->free[i]] = x[i];
    return s->full;
}

static void scale_rows(const struct solver *s, double *rows) {
    for (int k = 0; k < s->n_equal; k++) rows[s->equal[k]] *= s->row_scale[s->equal[k]];
}

static double scaled_values(struct solver *s, const double *x, double *rows) {
    double f = lift_values(s->p, complete(s, x), rows);
    scale_rows(s, rows);
    return s->objective_scale * f;
}

static void linearise(struct solver *s, const double *x) {
    s->objective = s->objective_scale * lift_first(s->p, complete(s, x), s->rows, s->full2);
    scale_rows(s, s->rows);
    for (int i = 0; i < s->n; i++) s->gradient[i] = s->objective_scale * s->full2[s->free[i]];
    lift_dense_rows(s->p, s->equal, s->n_equal, s->jacobian);
    for (int k = 0; k < s->n_equal; k++)
        for (int i = 0; i < s->n; i++)
            s->equality[(size_t)k * s->n + i] =
                s->row_scale[s->equal[k]] * s->jacobian[(size_t)k * s->n_all + s->free[i]];
}

static void jacobian_times(struct solver *s, const double *step, double *rows) {
    memset(s->full, 0, s->n_all * sizeof(double));
    for (int i = 0; i < s->n; i++) s->full[s->free[i]] = step[i];
    lift_times(s->p, s->full, rows);
    scale_rows(s, rows);
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

// ---- measures of the iterate ----------------------------------------------------------------

static double rows_residual(const struct solver *s, const double *rows, const double *v,
                            double *out) {
    double sum = 0.0;
    for (int k = 0; k < s->n_equal; k++) {
        int r = s->equal[k];
        out[r] = rows[r] - s->target[k];
        sum += fabs(out[r]);
    }
    for (int k = 0; k < s->n_slack; k++) {
        int r = s->unequal[k];
        out[r] = rows[r] - v[s->n + k];
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
    rows_residual(s, s->rows, s->v, s->residual);
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
    double s_d = larger(100.0, (e->sum_y + e->sum_z) / (count ? count : 1));
    double s_c = larger(100.0, e->sum_z / (e->bounds ? e->bounds : 1));
    double most = e->primal;
    double dual = 100.0 * e->dual / s_d, product = 100.0 * complementarity / s_c;
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
    if (s->n_filter == FILTER_ROOM) {  // forget the oldest
        memmove(s->filter_theta, s->filter_theta + 1, (FILTER_ROOM - 1) * sizeof(double));
        memmove(s->filter_phi, s->filter_phi + 1, (FILTER_ROOM - 1) * sizeof(double));
        s->n_filter--;
    }
    s->filter_theta[s->n_filter] = (1.0 - 1e-5) * theta;
    s->filter_phi[s->n_filter++] = phi - 1e-8 * theta;
}

static int judge(const struct solver *s, double theta, double phi, double trial_theta,
                 double trial_phi, double slope, double step, int *enter) {
    *enter = 0;
    if (!filter_accepts(s, trial_theta, trial_phi)) return 0;
    double rounding = 1e-14 * larger(1.0, fabs(phi));
    int switching = slope < 0.0 && step * pow(-slope, 2.3) > pow(theta, 1.1);
    int armijo = trial_phi <= phi + 1e-8 * step * slope + rounding;
    if (theta <= s->theta_small && switching) return armijo;
    int better = trial_theta <= (1.0 - 1e-5) * theta || trial_phi <= phi - 1e-8 * theta + rounding;
    *enter = better && !(switching && armijo);
    return better;
}

static double least_step(const struct solver *s, double theta, double slope) {
    double bound = 1e-5;
    if (slope < 0.0) {
        bound = smaller(bound, 1e-8 * theta / -slope);
        if (theta <= s->theta_small) bound = smaller(bound, pow(theta, 1.1) / pow(-slope, 2.3));
    }
    return 0.05 * bound;
}

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
        s->v[i] = inside(s->rows[s->unequal[k]], s->low[i], s->high[i], push);
    }
}

static void first_multipliers(struct solver *s) {
    memset(s->y, 0, s->m * sizeof(double));
    for (int i = 0; i < s->n_v; i++) {
        s->zl[i] = smaller(s->mu / (s->v[i] - s->low[i]), 1e3);
        s->zu[i] = smaller(s->mu / (s->high[i] - s->v[i]), 1e3);
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
    s->convexify = squares > 0.0 ? 10.0 * larger(trace / n, 1.0) * s->n_equal / squares : 0.0;
    if (s->convexify > 0.0)
        for (int k = 0; k < s->n_equal; k++) {
            const double *row = s->equality + (size_t)k * n;
            for (int i = 0; i < n; i++) {
                double factor = s->convexify * row[i];
                if (factor != 0.0)
                    for (int j = 0; j <= i; j++) s->matrix[(size_t)i * n + j] += factor * row[j];
            }
        }
    if (!cholesky(s->matrix, 0.0, s->factor, n)) {
        double shift = s->last_shift == 0.0 ? 1e-4 : larger(1e-20, s->last_shift / 3.0);
        double growth = s->last_shift == 0.0 ? 100.0 : 8.0;
        while (!cholesky(s->matrix, shift, s->factor, n)) {
            shift *= growth;
            if (!(shift < 1e40)) return 0;
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
            s->eq_work[(size_t)k * q + l] =
                dot(s->equality + (size_t)k * n, s->inner + (size_t)l * n, n);
    for (int k = 0; k < q; k++) most = larger(most, fabs(s->eq_work[(size_t)k * q + k]));
    double shift = 0.0;
    while (!cholesky(s->eq_work, shift, s->schur, q)) {
        shift = shift == 0.0 ? 1e-8 * most : 10.0 * shift;
        if (!isfinite(shift)) return 0;
    }
    return 1;
}

// Newton step for the given residual of the rows, into dv, dy, dzl, dzu.
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

static double boundary(const struct solver *s) { return larger(0.99, 1.0 - s->mu); }

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
        s->zl[i] = smaller(larger(s->zl[i], s->mu / (1e10 * low)), 1e10 * s->mu / low);
        s->zu[i] = smaller(larger(s->zu[i], s->mu / (1e10 * high)), 1e10 * s->mu / high);
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
        if (!(after <= 0.99 * before)) return 0;
        before = after, alpha = length;
    }
    return 0;
}

static int line_search(struct solver *s) {
    double slope = 0.0, theta = rows_residual(s, s->rows, s->v, s->residual);
    double phi = barrier_objective(s, s->objective, s->v);
    int tiny = 1;
    for (int i = 0; i < s->n_v; i++) {
        slope += s->barrier[i] * s->dv[i];
        if (i < s->n) slope += s->gradient[i] * s->dv[i];
        if (!(fabs(s->dv[i]) <= 10.0 * DBL_EPSILON * (1.0 + fabs(s->v[i])))) tiny = 0;
    }
    double first = longest_step(s);
    s->n_short = first < 0.1 ? s->n_short + 1 : 0;
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

// ---- feasibility restoration --------------------------------------------------------------------

static double violation_of(const struct solver *s, const double *rows, double *out) {
    double sum = 0.0;
    for (int k = 0; k < s->n_equal; k++) out[s->equal[k]] = rows[s->equal[k]] - s->target[k];
    for (int k = 0; k < s->n_slack; k++) {
        double value = rows[s->unequal[k]];
        double nearest = smaller(larger(value, s->low[s->n + k]), s->high[s->n + k]);
        out[s->unequal[k]] = value - nearest;
    }
    for (int r = 0; r < s->m; r++) sum += out[r] * out[r];
    return 0.5 * sum;
}

// Reduce half the squared violation of the rows; x in v. 1 if it has a minimum there.
static int restore(struct solver *s, double goal, int limit) {
    int n = s->n, stalled = 0, *held = (int *)s->eq_work;
    double damping = 1e-6, *violation = s->residual, *x = s->v, *gradient = s->free_work;
    scaled_values(s, x, s->rows);
    double value = violation_of(s, s->rows, violation);
    while (limit-- > 0) {
        double most = largest(violation, s->m);
        if (most <= goal) return 0;
        linearise(s, x);
        jacobian_transposed(s, violation, gradient);
        double steep = 0.0, sum = 0.0;
        for (int i = 0; i < n; i++) {
            held[i] = (x[i] <= s->low[i] && gradient[i] > 0.0) ||
                      (x[i] >= s->high[i] && gradient[i] < 0.0);
            if (!held[i]) steep = larger(steep, fabs(gradient[i])), sum += fabs(gradient[i]);
        }
        if (steep <= 1e-8 * larger(1.0, most) || sum <= 0.1 * value) return 1;
        s->iterations++;
        for (int r = 0; r < s->m; r++)
            s->row_work[r] = violation[r] != 0.0 ? s->row_scale[r] * s->row_scale[r] : 0.0;
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
        for (;; damping *= 10.0) {
            if (damping > 1e12) return 1;
            if (!cholesky(s->matrix, damping * size, s->factor, n)) continue;
            for (int i = 0; i < n; i++) s->free_work2[i] = held[i] ? 0.0 : -gradient[i];
            back_substitute(s->factor, s->free_work2, n);
            for (int i = 0; i < n; i++)
                s->trial_v[i] = smaller(larger(x[i] + s->free_work2[i], s->low[i]), s->high[i]);
            scaled_values(s, s->trial_v, s->trial_rows);
            after = violation_of(s, s->trial_rows, s->row_work2);
            if (after < value) break;
        }
        stalled = value - after <= 1e-3 * value ? stalled + 1 : 0;
        memcpy(x, s->trial_v, n * sizeof(double));
        memcpy(violation, s->row_work2, s->m * sizeof(double));
        value = after;
        damping = larger(0.1 * damping, 1e-6);
        if (stalled == 10) return 1;
    }
    return 0;
}

// -1: go on.
static int leave_dead_end(struct solver *s) {
    struct errors e = measure(s);
    if (scaled_error(s, &e, 0.0) <= 100.0 * s->set.tolerance) return OPTIMAL;
    double theta = rows_residual(s, s->rows, s->v, s->residual);
    if (theta <= s->set.tolerance || ++s->restorations > MAX_RESTORATIONS) return STUCK;
    filter_add(s, theta, barrier_objective(s, s->objective, s->v));
    int minimum = restore(s, 0.1 * s->set.infeasible_violation,
                          s->set.max_iterations - s->iterations);
    for (int i = 0; i < s->n; i++) s->v[i] = inside(s->v[i], s->low[i], s->high[i], 1e-8);
    linearise(s, s->v);
    violation_of(s, s->rows, s->residual);
    double most = largest(s->residual, s->m);
    slacks_from_rows(s, 1e-4);
    first_multipliers(s);
    if (minimum && most > s->set.infeasible_violation) return INFEASIBLE;
    return s->iterations >= s->set.max_iterations ? ITERATION_LIMIT : -1;
}

// ---- the method -------------------------------------------------------------------------------

static int iterate(struct solver *s) {
    if (!isfinite(s->objective) || !isfinite(largest(s->rows, s->m))) return NOT_FINITE;
    for (;;) {
        struct errors e = measure(s);
        if (scaled_error(s, &e, 0.0) <= s->set.tolerance) return OPTIMAL;
        double least = 0.1 * s->set.tolerance;
        while (s->mu > least && scaled_error(s, &e, s->mu) <= 10.0 * s->mu) {
            s->mu = larger(least, smaller(0.2 * s->mu, pow(s->mu, 1.5)));
            s->n_filter = 0;
        }
        if (s->iterations >= s->set.max_iterations) return ITERATION_LIMIT;
        if (now() - s->start_time > s->set.time_limit) return TIME_LIMIT;
        s->iterations++;
        if (!factorise(s)) return STUCK;
        newton_step(s, s->residual);
        if (!line_search(s) || (s->n_short == 12 && s->set.tolerance < e.primal)) {
            s->n_short = 0;
            int status = leave_dead_end(s);
            if (status >= 0) return status;
        }
    }
}

static void start(struct solver *s, const double *x0, const double *y, const double *z) {
    struct settings *set = &s->set;
    int n = s->n;
    lift_first(s->p, s->fixed, s->rows, s->full2);
    double steep = 0.0;
    for (int i = 0; i < n; i++) steep = larger(steep, fabs(s->full2[s->free[i]]));
    s->objective_scale = steep > set->gradient_limit ? set->gradient_limit / steep : 1.0;
    lift_dense_rows(s->p, s->equal, s->n_equal, s->jacobian);
    for (int k = 0; k < s->n_equal; k++) {
        double most = set->gradient_limit;
        for (int i = 0; i < n; i++)
            most = larger(most, fabs(s->jacobian[(size_t)k * s->n_all + s->free[i]]));
        s->row_scale[s->equal[k]] = set->gradient_limit / most;
        s->target[k] *= s->row_scale[s->equal[k]];
    }
    for (int i = n; i < s->n_v; i++) {
        s->low[i] -= 1e-8 * larger(1.0, fabs(s->low[i]));
        s->high[i] += 1e-8 * larger(1.0, fabs(s->high[i]));
    }
    for (int i = 0; i < n; i++)
        s->v[i] = inside(x0[s->free[i]], s->low[i], s->high[i], set->bound_push);
    linearise(s, s->v);
    slacks_from_rows(s, set->bound_push);
    s->mu = set->barrier;
    first_multipliers(s);
    if (set->warm) {
        for (int r = 0; r < s->m; r++) s->y[r] = s->objective_scale * y[r] / s->row_scale[r];
        for (int i = 0; i < s->n_v; i++) {
            double bound = i < n ? s->objective_scale * z[s->free[i]] : s->y[s->unequal[i - n]];
            double low = s->v[i] - s->low[i], high = s->high[i] - s->v[i];
            s->zl[i] = isfinite(low) ? larger(-bound, s->mu / low) : 0.0;
            s->zu[i] = isfinite(high) ? larger(bound, s->mu / high) : 0.0;
        }
    }
    double theta = rows_residual(s, s->rows, s->v, s->residual);
    s->theta_largest = 1e4 * larger(1.0, theta), s->theta_small = 1e-4 * larger(1.0, theta);
}

// Unscaled result; see Solution in solution.py.
static void finish(struct solver *s, const double *lower, const double *upper,
                   const double *row_lower, const double *row_upper, double *x, double *y,
                   double *z, struct outcome *out) {
    memcpy(x, complete(s, s->v), s->n_all * sizeof(double));
    for (int i = 0; i < s->n_all; i++) x[i] = smaller(larger(x[i], lower[i]), upper[i]);
    out->objective = lift_first(s->p, x, s->rows, s->full);
    out->primal = 0.0;
    for (int r = 0; r < s->m; r++) {
        y[r] = s->row_scale[r] * s->y[r] / s->objective_scale;
        out->primal = larger(out->primal, larger(row_lower[r] - s->rows[r], s->rows[r] - row_upper[r]));
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
int lift_solve(struct programme *p, const double *lower, const double *upper,
               const double *row_lower, const double *row_upper, const struct settings *set,
               double *x, double *y, double *z, struct outcome *out) {
    struct solver s = {.p = p, .set = *set, .m = p->m, .n_all = p->n, .start_time = now()};
    int n_all = p->n, m = p->m, q = 0, n = 0;
    for (int i = 0; i < n_all; i++) n += lower[i] != upper[i];
    for (int r = 0; r < m; r++) q += row_lower[r] == row_upper[r];
    s.n = n, s.n_equal = q, s.n_slack = m - q, s.n_v = n + m - q;
    size_t n_v = s.n_v, square = (size_t)n * n, eq = (size_t)q * n_all;
    size_t work = (size_t)q * q > (size_t)n ? (size_t)q * q : (size_t)n;
    double **arrays[] = {
        &s.low, &s.high, &s.v, &s.zl, &s.zu, &s.dv, &s.dzl, &s.dzu, &s.sigma, &s.trial_v,
        &s.barrier,
        &s.row_scale, &s.y, &s.dy, &s.rows, &s.residual, &s.residual2, &s.trial_rows,
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
        s.row_scale[r] = 1.0;
        if (row_lower[r] == row_upper[r]) {
            s.target[q] = row_lower[r], s.equal[q++] = r;
        } else {
            s.low[n + k] = row_lower[r], s.high[n + k] = row_upper[r], s.unequal[k++] = r;
        }
    }
    start(&s, x, y, z);
    out->status = iterate(&s);
    finish(&s, lower, upper, row_lower, row_upper, x, y, z, out);
    free(memory), free(indices), free(fixed);
    return 0;
}
