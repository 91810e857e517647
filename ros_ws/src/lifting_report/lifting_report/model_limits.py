# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""What a reader must know about the models before acting on a number."""

MODEL_LIMITS = (
    'The limits are for populations. Being below one is no guarantee for a single person; '
    'what one person tolerates depends on age, sex and health.',
    'L5-S1 compression and shear are computed, not measured. They depend on the orientation of '
    'the disc frame (the shaded band shows ten degrees of it), on the muscle strengths of the '
    'model and on co-contraction.',
    'Static optimisation shares the load among the muscles with the least squared activation. It '
    'finds no co-contraction of muscles that work against each other, so real loads can be '
    'higher.',
    'The optimal lift of a symmetric recording is planar and moves both arms and both legs alike. '
    'A lift to the side is predicted in space, within windows round the recorded postures and '
    'ground reactions.',
    '"Not necessary" compares the peak of the recorded lift with the peak of the lift that needs '
    'the least joint effort for the same person, box, feet and places. That lift is not the one '
    'with the least spine load.',
    'Anthropometry comes from mass, stature and sex unless lengths were measured; muscle '
    'strength is that of the scaled model, not of this person.',
    'Intra-abdominal pressure and passive tissue are not part of the load estimate.',
)
