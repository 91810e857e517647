// SPDX-FileCopyrightText: 2026 The lift monitor authors
// SPDX-License-Identifier: Apache-2.0
// Second derivatives of the nodes, gathered into the condensed matrix of the problem.

#if LANES == 8
enum { TILE = 4 };
#elif LANES == 4
enum { TILE = 2 };
#else
enum { TILE = 1 };
#endif
enum { SHARES = 16 / LANES };  // vectors that hold the shares of 4 times 4 control points
enum { FULL_ROW = 3, OF_INPUTS = 4 };  // a row with 3/4 of all inputs is treated as a full one

// ---- node matrix ------------------------------------------------------------------------------

// Rows that depend on most inputs, packed for squares_of_full_rows; returns how many there are.
static int pack_full_rows(const struct function *f, const vec *slope, const vec *weight,
                          vec *plain, vec *scaled) {
    int count = 0, panels = (f->n_in + TILE - 1) / TILE;
    for (int first = 0, last; first < f->n_jacobian; first = last) {
        int row = f->jacobian_row[first];
        for (last = first; last < f->n_jacobian && f->jacobian_row[last] == row;) last++;
        if ((last - first) * OF_INPUTS < f->n_in * FULL_ROW) continue;
        for (int panel = 0; panel < panels; panel++) {
            size_t at = ((size_t)panel * f->n_g + count) * TILE;
            for (int i = 0; i < TILE; i++) plain[at + i] = scaled[at + i] = (vec){0};
        }
        for (int i = first; i < last; i++) {
            int column = f->jacobian_column[i];
            size_t at = ((size_t)(column / TILE) * f->n_g + count) * TILE + column % TILE;
            plain[at] = slope[i];
            scaled[at] = weight[row] * slope[i];
        }
        count++;
    }
    return count;
}

// dense = sum of the weighted squares of the packed constraints; the lower triangle.
static void squares_of_full_rows(const struct function *f, int count, const vec *plain,
                                 const vec *scaled, vec *dense) {
    int n = f->n_in, panels = (n + TILE - 1) / TILE;
    for (int i = 0; i < panels; i++)
        for (int j = 0; j <= i; j++) {
            const vec *left = scaled + (size_t)i * f->n_g * TILE;
            const vec *right = plain + (size_t)j * f->n_g * TILE;
            vec sum[TILE][TILE] = {{{0}}};
            for (int r = 0; r < count; r++, left += TILE, right += TILE)
#pragma GCC unroll 4
                for (int a = 0; a < TILE; a++)
#pragma GCC unroll 4
                    for (int b = 0; b < TILE; b++) sum[a][b] += left[a] * right[b];
            for (int a = 0; a < TILE && i * TILE + a < n; a++)
                for (int b = 0; b < TILE && j * TILE + b <= i * TILE + a; b++)
                    dense[(i * TILE + a) * n + j * TILE + b] = sum[a][b];
        }
}

// Node matrix (n_in, n_in), lower triangle: Hessian of the Lagrangian and weighted squares.
static void node_matrix(struct problem *p, struct group *g, int b, vec *dense) {
    const struct function *f = function_of(g);
    const vec *in = g->in + (size_t)b * f->n_in;
    const vec *slope = g->out + (size_t)b * n_out(f) + 1 + f->n_g + f->n_in;
    int n = f->n_in;
    int count = pack_full_rows(f, slope, g->weight, p->plain, p->scaled);
    squares_of_full_rows(f, count, p->plain, p->scaled, dense);
    if (f->n_hessian) {
        f->second(in, p->parameters, g->multiplier, g->second);
        for (int i = 0; i < f->n_hessian; i++)
            dense[f->hessian_row[i] * n + f->hessian_column[i]] += g->second[i];
    }
    for (int first = 0, last; first < f->n_jacobian; first = last) {
        int row = f->jacobian_row[first];
        for (last = first; last < f->n_jacobian && f->jacobian_row[last] == row;) last++;
        if ((last - first) * OF_INPUTS >= n * FULL_ROW) continue;
        for (int i = first; i < last; i++) {
            vec scaled = g->weight[row] * slope[i];
            vec *line = dense + f->jacobian_column[i] * n;
            for (int j = first; j <= i; j++) line[f->jacobian_column[j]] += scaled * slope[j];
        }
    }
}

// ---- from nodes to variables --------------------------------------------------------------------

// A channel as part of node inputs (from `at`) and locals (from `to`); the scalars are the last.
struct view { int at, to, width, orders, active; };

static void views_of(const struct group *g, struct view *views) {
    int at = 0, to = 0;
    for (int c = 0; c < g->n_channels; c++) {
        views[c] = (struct view){at, to, g->width[c], g->orders[c], g->active[c]};
        at += g->orders[c] * g->width[c], to += g->active[c] * g->width[c];
    }
    views[g->n_channels] = (struct view){at, to, g->n_scalars, 1, 1};
}

// Numbers of one output vector, for all orders of both channels and all lanes.
static size_t shares_size(struct view a, struct view b) {
    int outputs = a.active * b.active, vectors = (outputs + LANES - 1) / LANES;
    vectors = (vectors + SHARES - 1) / SHARES * SHARES;
    return (size_t)a.orders * b.orders * LANES * vectors * LANES;
}

static size_t shares_of_batch(const struct group *g) {
    struct view views[g->n_channels + 1];
    size_t size = 0;
    views_of(g, views);
    for (int c = 0; c <= g->n_channels; c++)
        for (int d = 0; d <= c; d++) size += shares_size(views[c], views[d]);
    return size;
}

static double weight_of(const struct group *g, const double *basis, int channel, int order,
                        int point, int lane) {
    if (channel == g->n_channels) return 1.0;
    for (int c = 0; c < channel; c++) basis += g->orders[c] * g->active[c] * LANES;
    return basis[(order * g->active[channel] + point) * LANES + lane];
}

// Shares of the pairs of control points in the elements of the node matrix: products of the
// spline's weights, which are the same for all components of two channels.
static void fill_shares(const struct group *g, double *shares) {
    struct view views[g->n_channels + 1];
    views_of(g, views);
    for (int batch = 0; batch < g->n_batches; batch++) {
        const double *basis = g->basis + (size_t)batch * basis_size(g) * LANES;
        for (int c = 0; c <= g->n_channels; c++)
            for (int d = 0; d <= c; d++) {
                struct view a = views[c], b = views[d];
                size_t size = shares_size(a, b), line = size / (a.orders * b.orders * LANES);
                for (int o = 0; o < a.orders; o++)
                    for (int u = 0; u < b.orders; u++)
                        for (int l = 0; l < LANES; l++)
                            for (int i = 0; i < a.active * b.active; i++)
                                shares[((o * b.orders + u) * LANES + l) * line + i] =
                                    weight_of(g, basis, c, o, i / b.active, l) *
                                    weight_of(g, basis, d, u, i % b.active, l);
                shares += size;
            }
    }
}

// Add the elements of two channels to the matrix: lanes from `first` to `last` with the variables
// `global` of one lane.
static void add_pair(struct view a, struct view b, const vec *dense, int n_in,
                     const double *shares, int first, int last, const int *global, double *out,
                     int n) {
    int same = a.at == b.at, outputs = a.active * b.active;
    size_t line = shares_size(a, b) / (a.orders * b.orders * LANES);
    for (int j = 0; j < a.width; j++) {
        int end = same ? j + 1 : b.width;
        for (int k = 0; k < end; k += TILE)
            for (int part = 0; part < outputs; part += SHARES * LANES) {
                vec sum[TILE][SHARES] = {{{0}}};
                for (int o = 0; o < a.orders; o++)
                    for (int u = 0; u < b.orders; u++) {
                        const double *element[TILE];
                        const double *share =
                            shares + (size_t)(o * b.orders + u) * LANES * line + part;
                        int row = a.at + o * a.width + j;
                        for (int t = 0; t < TILE; t++) {
                            int beside = k + t < end ? k + t : end - 1;
                            int column = b.at + u * b.width + beside;
                            int place = row >= column ? row * n_in + column : column * n_in + row;
                            element[t] = (const double *)(dense + place);
                        }
                        for (int l = first; l < last; l++)
#pragma GCC unroll 8
                            for (int v = 0; v < SHARES; v++) {
                                vec weight = *(const vec *)(share + l * line + v * LANES);
#pragma GCC unroll 4
                                for (int t = 0; t < TILE; t++)
                                    sum[t][v] += spread(element[t][l]) * weight;
                            }
                    }
                for (int t = 0; t < TILE && k + t < end; t++)
                    for (int i = part; i < outputs && i < part + SHARES * LANES; i++) {
                        int ka = i / b.active, kb = i % b.active;
                        // Both halves of an element's own block are the same.
                        if (same && j == k + t && kb > ka) continue;
                        int row = global[(a.to + ka * a.width + j) * LANES];
                        int column = global[(b.to + kb * b.width + k + t) * LANES];
                        int at = i - part;
                        out[(size_t)row * n + column] += sum[t][at / LANES][at % LANES];
                    }
            }
    }
}

static void add_batch(const struct group *g, int batch, const vec *dense, int n_in, double *out,
                      int n) {
    struct view views[g->n_channels + 1];
    const int *global = g->global + (size_t)batch * g->n_locals * LANES;
    const int *used = g->row + (size_t)batch * LANES;
    const double *shares = g->shares + (size_t)batch * shares_of_batch(g);
    views_of(g, views);
    for (int c = 0; c <= g->n_channels; c++)
        for (int d = 0; d <= c; d++) {
            struct view a = views[c], b = views[d];
            if (g->uniform[batch]) {
                add_pair(a, b, dense, n_in, shares, 0, LANES, global, out, n);
            } else {
                for (int l = 0; l < LANES; l++)
                    if (used[l] >= 0)
                        add_pair(a, b, dense, n_in, shares, l, l + 1, global + l, out, n);
            }
            shares += shares_size(a, b);
        }
}

// sigma Hess f + sum multiplier_i Hess g_i + sum weight_i J_i' J_i at the last point of lift_first.
void lift_condensed(struct problem *p, double sigma, const double *multiplier,
                    const double *weight, double *out) {
    double *square = p->square;
    int n = p->n;
    memset(square, 0, (size_t)n * n * sizeof *square);
    for (int k = 0; k < p->n_groups; k++) {
        struct group *g = &p->groups[k];
        const struct function *f = function_of(g);
        for (int b = 0; b < g->n_batches; b++) {
            g->multiplier[0] = sigma * *((const vec *)g->cost_weight + b);
            fetch(g, b, f->n_g, multiplier, g->multiplier + 1);
            fetch(g, b, f->n_g, weight, g->weight);
            node_matrix(p, g, b, p->dense);
            add_batch(g, b, p->dense, f->n_in, square, n);
        }
    }
    // Each pair was added once, on whichever side of the diagonal.
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) {
            double sum = square[(size_t)i * n + j] + (i == j ? 0.0 : square[(size_t)j * n + i]);
            out[(size_t)i * n + j] = out[(size_t)j * n + i] = sum;
        }
}

// ---- work space -------------------------------------------------------------------------------

void lift_close(struct problem *p) {
    if (!p) return;
    for (int k = 0; p->groups && k < p->n_groups; k++) {
        struct group *g = &p->groups[k];
        free(g->in), free(g->out), free(g->multiplier), free(g->weight), free(g->second);
        free(g->shares);
    }
    free(p->groups), free(p->dense), free(p->plain), free(p->scaled), free(p->square), free(p);
}

// A problem with work space of its own; the tables must live as long. NULL: no memory.
struct problem *lift_open(int n, int m, int n_groups, const struct group *groups) {
    struct problem *p = calloc(1, sizeof *p);
    if (!p) return NULL;
    p->n = n, p->m = m, p->n_groups = n_groups;
    p->groups = calloc(n_groups, sizeof *groups);
    p->square = room(((size_t)n * n + LANES - 1) / LANES);
    int in = 1, ok = p->groups && p->square;
    size_t packed = 1;
    for (int k = 0; ok && k < n_groups; k++) {
        struct group *g = &p->groups[k];
        *g = groups[k];
        const struct function *f = function_of(g);
        g->in = room((size_t)g->n_batches * f->n_in);
        g->out = room((size_t)g->n_batches * n_out(f));
        g->multiplier = room(1 + f->n_g);
        g->weight = room(1 + f->n_g);
        g->second = room(f->n_hessian);
        g->shares = room(g->n_batches * shares_of_batch(g) / LANES);
        ok = g->in && g->out && g->multiplier && g->weight && g->second && g->shares;
        if (ok) fill_shares(g, g->shares);
        if (f->n_in > in) in = f->n_in;
        size_t size = (size_t)(f->n_in + TILE) * f->n_g;
        if (size > packed) packed = size;
    }
    p->dense = room((size_t)in * in);
    p->plain = room(packed);
    p->scaled = room(packed);
    if (ok && p->dense && p->plain && p->scaled) return p;
    lift_close(p);
    return NULL;
}
