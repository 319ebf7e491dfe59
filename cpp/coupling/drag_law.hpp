#pragma once

#include "core/vec3.hpp"

#include <concepts>
#include <type_traits>

namespace mpsdem::coupling {

/// A drag law is a small value type that turns the state around a sphere into the size of its drag.
///
/// Both arguments are those of the literature on Model A, where the pressure gradient acts on the
/// solids apart from the drag F_A (Zhou et al. 2010, doi:10.1017/S002211201000306X):
///
///   reynolds      eps |r| d / nu, the superficial slip;  r = u - v, liquid less solid  [-]
///   void_fraction eps, the liquid's share of the volume around the sphere              [-]
///
/// `force_ratio` is |F_A| / (3 pi mu d eps |r|): Stokes's drag on the superficial slip is 1. It
/// must stay finite as reynolds -> 0. `covers` says whether the law's sources stand behind it
/// there.
template <class Law>
concept DragLaw = std::is_trivially_copyable_v<Law> &&
                  requires(const Law& law, Real reynolds, Real void_fraction) {
                      { law.force_ratio(reynolds, void_fraction) } noexcept -> std::same_as<Real>;
                      { law.covers(reynolds, void_fraction) } noexcept -> std::same_as<bool>;
                  };

} // namespace mpsdem::coupling
