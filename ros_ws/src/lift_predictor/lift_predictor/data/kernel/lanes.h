// SPDX-FileCopyrightText: 2026 The lift monitor authors
// SPDX-License-Identifier: Apache-2.0
// Vectors of doubles, one time node in each lane (GCC's vector extensions).

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#if defined(__AVX512F__)
#define LANES 8
#elif defined(__AVX2__)
#define LANES 4
#else
#define LANES 2
#endif

typedef double vec __attribute__((vector_size(LANES * 8)));
typedef int64_t ivec __attribute__((vector_size(LANES * 8)));

static inline vec spread(double a) { return a - (vec){0}; }

// A function of each lane: by glibc's vector library where the compiler found it, else one by one.
#define BY_LANE(name) \
    static inline vec v_##name(vec a) { \
        for (int i = 0; i < LANES; i++) a[i] = name(a[i]); \
        return a; \
    }
#ifdef VECTOR_LIBM
#if LANES == 8
#define VECTOR_NAME(name) _ZGVeN8v_##name
#elif LANES == 4
#define VECTOR_NAME(name) _ZGVdN4v_##name
#else
#define VECTOR_NAME(name) _ZGVbN2v_##name
#endif
#define BY_LIBRARY(name) \
    extern vec VECTOR_NAME(name)(vec); \
    static inline vec v_##name(vec a) { return VECTOR_NAME(name)(a); }
BY_LIBRARY(sin) BY_LIBRARY(cos) BY_LIBRARY(exp) BY_LIBRARY(log) BY_LIBRARY(tanh)
#else
BY_LANE(sin) BY_LANE(cos) BY_LANE(exp) BY_LANE(log) BY_LANE(tanh)
#endif
BY_LANE(sqrt) BY_LANE(tan) BY_LANE(asin) BY_LANE(acos) BY_LANE(atan) BY_LANE(fabs)

#define BY_LANE2(name) \
    static inline vec v_##name(vec a, vec b) { \
        for (int i = 0; i < LANES; i++) a[i] = name(a[i], b[i]); \
        return a; \
    }
BY_LANE2(pow) BY_LANE2(atan2) BY_LANE2(fmin) BY_LANE2(fmax) BY_LANE2(copysign)

// Truth values are 0 and 1, as in the expressions they come from.
static inline vec truth(ivec mask) { return (vec)(mask & (ivec)spread(1.0)); }
static inline vec v_if(vec condition, vec a) { return (vec)((condition != 0.0) & (ivec)a); }
static inline vec v_sign(vec a) { return truth(a > 0.0) - truth(a < 0.0); }

// A node function: inputs in (z, s) of n_in values, parameters, outputs; see node_function.py.
struct function {
    const char *name;
    int n_in, n_parameters, n_g, n_jacobian, n_hessian;
    const int *jacobian_row, *jacobian_column;  // sorted by row
    const int *hessian_row, *hessian_column;    // lower triangle
    void (*value)(const vec *in, const double *p, vec *out);   // cost, g
    void (*first)(const vec *in, const double *p, vec *out);   // cost, g, gradient, Jacobian
    void (*second)(const vec *in, const double *p, const vec *multiplier, vec *out);
};
