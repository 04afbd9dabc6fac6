// Copyright 2026 The pam_ros authors
// SPDX-License-Identifier: Apache-2.0
//
// The paper's rig in plain C, as one would write it by hand: the reference for plant_step.py.
// The same equations and the same integrator as in pam_ros/rig/kernel.py, without effects.

#include <math.h>

typedef struct {
    double a1, a2, a3, a4, a5, a6, zeta, l0, mass, gravity;
} Rig;

// Pull and damping coefficient at a position: equations (1), (2) and (4).
static void muscle(const Rig *q, double y, double p, double *pull, double *damping)
{
    double kappa = y / q->l0;
    double e = exp(q->a3 * kappa);
    double k = -((q->a1 * p + q->a2) * q->a3 * e + q->a4 * p) / q->l0;
    *pull = (q->a1 * p + q->a2) * e + q->a4 * kappa * p + q->a5 * p + q->a6;
    *damping = k > 0.0 ? 2.0 * q->zeta * sqrt(q->mass * k) : 0.0;
}

void advance(const Rig *q, double *state, double p, long steps, double h)
{
    double y = state[0], v = state[1];
    for (long i = 0; i < steps; i++) {
        double f, c;
        muscle(q, y, p, &f, &c);
        double a1 = (f - c * v) / q->mass - q->gravity;
        muscle(q, y + 0.5 * h * v + 0.125 * h * h * a1, p, &f, &c);
        double a2 = (f - c * (v + 0.5 * h * a1)) / q->mass - q->gravity;
        double a3 = (f - c * (v + 0.5 * h * a2)) / q->mass - q->gravity;
        muscle(q, y + h * v + 0.5 * h * h * a3, p, &f, &c);
        double a4 = (f - c * (v + h * a3)) / q->mass - q->gravity;
        y += h * v + h * h * (a1 + a2 + a3) / 6.0;
        v += h * (a1 + 2.0 * a2 + 2.0 * a3 + a4) / 6.0;
    }
    state[0] = y;
    state[1] = v;
}
