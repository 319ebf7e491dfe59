#pragma once

#include "mps/eulerian/section.hpp"
#include "mps/eulerian/stencil.hpp"

namespace mpsdem::mps::eulerian {

/// Operators across the pipe from the quadratic polynomial through f_i that fits the neighbors
/// best:
///
///   minimise sum_j W (p_j . c - (f_j - f_i))^2        p = (y, z, y^2 / 2, z^2 / 2, yz) of r_ij
///
/// Exact for quadratic fields, so for Poiseuille flow. W is that of MPS with the radius r_e below;
/// where the neighbors within it do not fix the polynomial well, r_e grows by 1.12 until they do.
/// Source: Tamai & Koshizuka (2014), doi:10.1007/s40571-014-0027-2, type A.
/// Every node has a row, those on the wall too.
///
/// Weights 0 and 1 give d/dy and d/dz [1/m]; r_e = 2.1 spacings.
[[nodiscard]] Stencil<2> gradient_stencil(const Section& section);

/// Weight 0 gives d^2/dy^2 + d^2/dz^2 [1/m2]; r_e = 1.6 spacings, about 8 neighbors: near to the
/// smallest stencil, so that the roughest fields are seen.
[[nodiscard]] Stencil<1> laplacian_stencil(const Section& section);

/// Weights 0 and 1 as `gradient_stencil`; 2 and 3 are the damping of upwind differences,
///
///   E_a = (D_a- - D_a+) / 2      D_a+-: fits with W (1 +- 0.8 r_a / r), looking along +-a
///
/// so that u D f taken from upwind is u C f + |u| E f. E vanishes for quadratics and damps short
/// waves like |u| dx^3 d^4 f / da^4. r_e = 2.6 spacings for it.
[[nodiscard]] Stencil<4> upwind_stencil(const Section& section);

} // namespace mpsdem::mps::eulerian
