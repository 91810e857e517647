// SPDX-FileCopyrightText: 2026 The lift monitor authors
// SPDX-License-Identifier: Apache-2.0
// Node functions mapped over the nodes of splines and gathered into a dense problem.
//
// A group is one node function at many instants. The instants are sorted into batches of LANES;
// what a batch needs of the splines is in constant tables made by layout.py:
//   locals: the variables a batch depends on; channel by channel, control point by control point,
//           component by component, then the scalars; `global` tells which variable each one is;
//   basis:  per channel and order of differentiation the weight of each of its control points.

struct group {
    int function, n_batches, n_channels, n_locals, n_scalars, costless;
    const int *width, *orders, *active;  // of each channel
    const int *global;                   // (n_batches, n_locals, LANES)
    const int *uniform;                  // (n_batches): all lanes have the same variables
    const double *basis;                 // (n_batches, sum of orders * active, LANES)
    const double *cost_weight;           // (n_batches, LANES), 0 in unused lanes
    const int *row;                      // (n_batches, LANES): first row of the node; -1: unused
    vec *in, *out, *multiplier, *weight, *second;  // work space, by batch where it is kept
    double *shares;                                // tables of condense.c
};

struct problem {
    int n, m, n_groups;
    struct group *groups;
    const double *parameters;
    vec *dense, *plain, *scaled;  // work space of one batch
    double *square;               // (n, n)
};

extern const struct function lift_functions[];
extern const int lift_n_functions;

int lift_lanes(void) { return LANES; }

const struct function *lift_function(int i) {
    return i < lift_n_functions ? &lift_functions[i] : NULL;
}

static void *room(size_t count) {
    size_t bytes = (count * sizeof(vec) + 63) / 64 * 64;
    void *memory = aligned_alloc(64, bytes ? bytes : 64);
    if (memory) memset(memory, 0, bytes ? bytes : 64);
    return memory;
}

static const struct function *function_of(const struct group *g) {
    return &lift_functions[g->function];
}

static int n_out(const struct function *f) { return 1 + f->n_g + f->n_in + f->n_jacobian; }

void lift_parameters(struct problem *p, const double *parameters) { p->parameters = parameters; }

static int basis_size(const struct group *g) {
    int size = 0;
    for (int c = 0; c < g->n_channels; c++) size += g->orders[c] * g->active[c];
    return size;
}

// Node inputs from variables.
static void gather(const struct group *g, int batch, const double *x, vec *in) {
    const int *global = g->global + (size_t)batch * g->n_locals * LANES;
    const vec *basis = (const vec *)g->basis + (size_t)batch * basis_size(g);
    int at = 0, local = 0;
    for (int c = 0; c < g->n_channels; c++) {
        int width = g->width[c], active = g->active[c];
        for (int k = 0; k < active; k++)
            for (int j = 0; j < width; j++) {
                vec value;
                const int *index = global + (local + k * width + j) * LANES;
                for (int l = 0; l < LANES; l++) value[l] = x[index[l]];
                for (int o = 0; o < g->orders[c]; o++) {
                    vec term = basis[o * active + k] * value;
                    in[at + o * width + j] = k ? in[at + o * width + j] + term : term;
                }
            }
        at += g->orders[c] * width, local += active * width, basis += g->orders[c] * active;
    }
    for (int j = 0; j < g->n_scalars; j++)
        for (int l = 0; l < LANES; l++) in[at + j][l] = x[global[(local + j) * LANES + l]];
}

// Sum of a vector by node inputs into one by variables.
static void spread_back(const struct group *g, int batch, const vec *in, double *x) {
    const int *global = g->global + (size_t)batch * g->n_locals * LANES;
    const vec *basis = (const vec *)g->basis + (size_t)batch * basis_size(g);
    int at = 0, local = 0;
    for (int c = 0; c < g->n_channels; c++) {
        int width = g->width[c], active = g->active[c];
        for (int k = 0; k < active; k++)
            for (int j = 0; j < width; j++) {
                vec value = {0};
                const int *index = global + (local + k * width + j) * LANES;
                for (int o = 0; o < g->orders[c]; o++)
                    value += basis[o * active + k] * in[at + o * width + j];
                for (int l = 0; l < LANES; l++) x[index[l]] += value[l];
            }
        at += g->orders[c] * width, local += active * width, basis += g->orders[c] * active;
    }
    for (int j = 0; j < g->n_scalars; j++)
        for (int l = 0; l < LANES; l++) x[global[(local + j) * LANES + l]] += in[at + j][l];
}

static double reduce(const struct group *g, int batch, vec cost, const vec *constraints, int n_g,
                     double *out) {
    double sum = 0.0;
    const double *weight = g->cost_weight + (size_t)batch * LANES;
    const int *row = g->row + (size_t)batch * LANES;
    for (int l = 0; l < LANES; l++) {
        if (row[l] < 0) continue;
        if (weight[l] != 0.0) sum += weight[l] * cost[l];
        for (int r = 0; r < n_g; r++) out[row[l] + r] = constraints[r][l];
    }
    return sum;
}

// Objective and constraints.
double lift_values(struct problem *p, const double *x, double *constraints) {
    double objective = 0.0;
    for (int k = 0; k < p->n_groups; k++) {
        struct group *g = &p->groups[k];
        const struct function *f = function_of(g);
        vec in[f->n_in + 1], out[1 + f->n_g];
        for (int b = 0; b < g->n_batches; b++) {
            gather(g, b, x, in);
            f->value(in, p->parameters, out);
            objective += reduce(g, b, out[0], out + 1, f->n_g, constraints);
        }
    }
    return objective;
}

// Objective, constraints, gradient; the Jacobian is kept for the functions below.
double lift_first(struct problem *p, const double *x, double *constraints, double *gradient) {
    double objective = 0.0;
    memset(gradient, 0, p->n * sizeof *gradient);
    for (int k = 0; k < p->n_groups; k++) {
        struct group *g = &p->groups[k];
        const struct function *f = function_of(g);
        vec slope[f->n_in + 1];
        for (int b = 0; b < g->n_batches; b++) {
            vec *in = g->in + (size_t)b * f->n_in, *out = g->out + (size_t)b * n_out(f);
            vec weight = *((const vec *)g->cost_weight + b);
            gather(g, b, x, in);
            f->first(in, p->parameters, out);
            objective += reduce(g, b, out[0], out + 1, f->n_g, constraints);
            for (int i = 0; i < f->n_in; i++) slope[i] = weight * out[1 + f->n_g + i];
            if (!g->costless) spread_back(g, b, slope, gradient);
        }
    }
    return objective;
}

// Jacobian times a step.
void lift_times(struct problem *p, const double *step, double *constraints) {
    for (int k = 0; k < p->n_groups; k++) {
        struct group *g = &p->groups[k];
        const struct function *f = function_of(g);
        vec in[f->n_in + 1], out[f->n_g + 1];
        for (int b = 0; b < g->n_batches; b++) {
            const vec *slope = g->out + (size_t)b * n_out(f) + 1 + f->n_g + f->n_in;
            gather(g, b, step, in);
            memset(out, 0, sizeof out);
            for (int i = 0; i < f->n_jacobian; i++)
                out[f->jacobian_row[i]] += slope[i] * in[f->jacobian_column[i]];
            reduce(g, b, out[0], out, f->n_g, constraints);
        }
    }
}

static void fetch(const struct group *g, int batch, int n_g, const double *values, vec *out) {
    const int *row = g->row + (size_t)batch * LANES;
    for (int l = 0; l < LANES; l++)
        for (int r = 0; r < n_g; r++) out[r][l] = row[l] < 0 ? 0.0 : values[row[l] + r];
}

// Transposed Jacobian times multipliers.
void lift_transposed(struct problem *p, const double *multiplier, double *out) {
    memset(out, 0, p->n * sizeof *out);
    for (int k = 0; k < p->n_groups; k++) {
        struct group *g = &p->groups[k];
        const struct function *f = function_of(g);
        vec in[f->n_in + 1];
        for (int b = 0; b < g->n_batches; b++) {
            const vec *slope = g->out + (size_t)b * n_out(f) + 1 + f->n_g + f->n_in;
            fetch(g, b, f->n_g, multiplier, g->multiplier);
            memset(in, 0, sizeof in);
            for (int i = 0; i < f->n_jacobian; i++)
                in[f->jacobian_column[i]] += slope[i] * g->multiplier[f->jacobian_row[i]];
            spread_back(g, b, in, out);
        }
    }
}

// Dense Jacobian of the listed constraints, (count, n), which must be sorted.
void lift_dense_rows(struct problem *p, const int *wanted, int count, double *out) {
    memset(out, 0, (size_t)count * p->n * sizeof *out);
    for (int k = 0; k < p->n_groups; k++) {
        struct group *g = &p->groups[k];
        const struct function *f = function_of(g);
        vec in[f->n_in + 1];
        for (int b = 0; b < g->n_batches; b++) {
            const vec *slope = g->out + (size_t)b * n_out(f) + 1 + f->n_g + f->n_in;
            const int *row = g->row + (size_t)b * LANES;
            for (int l = 0; l < LANES; l++) {
                if (row[l] < 0) continue;
                int low = 0, high = count;
                while (low < high) {
                    int middle = (low + high) / 2;
                    if (wanted[middle] < row[l]) low = middle + 1; else high = middle;
                }
                for (; low < count && wanted[low] < row[l] + f->n_g; low++) {
                    memset(in, 0, sizeof in);
                    for (int i = 0; i < f->n_jacobian; i++)
                        if (f->jacobian_row[i] == wanted[low] - row[l])
                            in[f->jacobian_column[i]][l] = slope[i][l];
                    spread_back(g, b, in, out + (size_t)low * p->n);
                }
            }
        }
    }
}

// One function at n instants: in (n, n_in), out (n, 1 + n_g), cost first.
void lift_evaluate(int function, int n, const double *in, const double *parameters, double *out) {
    const struct function *f = &lift_functions[function];
    vec block[f->n_in + 1], result[1 + f->n_g];
    for (int start = 0; start < n; start += LANES) {
        for (int l = 0; l < LANES; l++) {
            int at = start + l < n ? start + l : n - 1;
            for (int i = 0; i < f->n_in; i++) block[i][l] = in[(size_t)at * f->n_in + i];
        }
        f->value(block, parameters, result);
        for (int l = 0; l < LANES && start + l < n; l++)
            for (int r = 0; r <= f->n_g; r++)
                out[(size_t)(start + l) * (1 + f->n_g) + r] = result[r][l];
    }
}
