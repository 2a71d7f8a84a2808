// SPDX-License-Identifier: GPL-3.0-or-later
// Eigen's solvers with the same rounding on every processor. On ARM64 Eigen uses fused multiply-add intrinsics regardless of
// compiler flags, where SSE2 rounds twice; this replaces them with separate operations.
#pragma once

#ifdef __aarch64__
#include <arm_neon.h>
#define vfmaq_f64(sum, a, b) vaddq_f64(sum, vmulq_f64(a, b))
#define vfmaq_n_f64(sum, a, b) vaddq_f64(sum, vmulq_n_f64(a, b))
#define vfmaq_laneq_f64(sum, a, b, lane) vaddq_f64(sum, vmulq_laneq_f64(a, b, lane))
#endif

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
