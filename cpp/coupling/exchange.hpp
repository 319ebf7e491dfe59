#pragma once

#include "coupling/footprints.hpp"

#include <span>
#include <vector>

namespace mpsdem::coupling {

/// What solids did over a step of the liquid, one entry per solid.
struct SolidsStep {
    std::span<const Vec3> position;      // [m] at its start
    std::span<const Vec3> mean_velocity; // [m/s]
    std::span<const Real> drag;          // [kg/s] K, drag over slip, mean
    std::span<const Vec3> impulse;       // [N s] that the liquid gave them; empty: whatever J is
    Real duration;                       // [s]
};

/// How the liquid at each solid changes in substeps: du/dt = acceleration - relaxation (u - v).
struct Response {
    std::vector<Vec3> acceleration; // [m/s2]
    std::vector<Real> relaxation;   // [1/s]
};

/// Two-way exchange between solids and a liquid, in Model B: the solids feel drag and the buoyancy
/// of liquid at rest, and all else is the liquid's pressure.
///
///   eps_i = 1 - sum_p V_p w_ip / V_i                 void fraction, at least 0.3 (counted)
///   s_i   = sum_p V_p v_p w_ip / V_i                 flux of the solids
///   beta_i, D_i = sum_p (K_p, K_p v_p) w_ip / V_i    drag, implicit in the liquid's step
///   J_p   = K_p dt sum_i w_ip (u_i - v_p)            impulse by it
///
/// The solids have meanwhile got I_p, from substeps in which the liquid responds,
///
///   du_p/dt = b_p + L_p (u_p^0 - v_p^0) - sum_i w_ip (beta_i u_i^0 - D_i) / (rho eps_i)
///             - L_p (u_p - v_p),      L_p = sum_i w_ip beta_i / (rho eps_i)
///
/// b_p is what all but drag did to it in the step before: at first the liquid changes as its points
/// do, which feel other solids too, and then as its slip from this solid changes. The difference is
/// spread with the same weights after the liquid's step, so that the exchange is equal and opposite
/// to round-off, and small where the substeps foresaw the liquid well.
///
/// Source: Zhou, Kuang, Chu & Yu (2010), doi:10.1017/S002211201000306X, set II (Model B).
class Exchange final : public mps::Loading {
public:
    static constexpr Real least_void_fraction = 0.3; // [-] a clip, counted

    Exchange(Real smoothing_radius, Real liquid_density, int threads);

    /// Look at the liquid around the solids at the start of a step.
    void begin(const mps::LiquidPoints& points, std::span<const Vec3> velocity,
               std::span<const Vec3> acceleration, std::span<const Vec3> position,
               std::span<const Real> radius);
    [[nodiscard]] std::span<const Vec3> liquid_velocity() const noexcept { return velocity_; }
    /// How the liquid at the solids will change, for K [kg/s] and v of the solids now, as they lie
    /// at the start of the step.
    [[nodiscard]] Response response(std::span<const Real> drag, std::span<const Vec3> velocity);

    /// Take what the solids did; the next advance of the liquid hears of it.
    void give(const SolidsStep& step);

    [[nodiscard]] mps::Load before(const mps::LiquidPoints& points, Real elapsed, Real dt) override;
    [[nodiscard]] std::span<const Vec3> owed(std::span<const Vec3> velocity) override;

    /// Impulse on each solid in the last step of the liquid [N s].
    [[nodiscard]] std::span<const Vec3> impulse() const noexcept { return received_; }
    /// Void fractions of liquid points raised to the floor in that step, over its substeps.
    [[nodiscard]] std::size_t clipped() const noexcept { return clipped_; }
    /// Impulse handed to the liquid and got by the solids together, over the sum of the sizes of
    /// those on the solids [-]: that nothing is lost between them. What the liquid then makes of it
    /// is its own ledger's.
    [[nodiscard]] Real mismatch() const noexcept;
    /// Volume of the liquid by its void fractions, over bore less solids, less 1 [-].
    [[nodiscard]] Real liquid_volume_error() const noexcept { return liquid_volume_error_; }

private:
    void find_touched();

    Footprints footprints_;
    Real density_; // [kg/m3] of the liquid
    int threads_;

    // Of the solids.
    std::vector<Vec3> velocity_, acceleration_; // of the liquid at them, at the start
    std::vector<Real> volume_;                  // [m3]
    std::vector<Vec3> start_, position_, mean_velocity_, impulse_, received_, got_, rest_;
    std::vector<Real> drag_;
    Real duration_ = 0;
    bool given_ = true; // whether the step begun has been given
    bool free_ = true;  // whether the solids say what impulse they got

    // Of the liquid's points.
    mps::LiquidPoints points_{};
    std::span<const Vec3> field_; // [m/s] the liquid's velocity at the start
    std::vector<Index> touched_;  // that solids act on, when the step begins
    std::vector<Real> per_mass_;  // [1/kg] of the liquid of those
    std::vector<mps::LoadAt> load_;
    std::vector<Vec3> owed_;
    Real step_ = 0; // [s] of the substep under way
    std::size_t clipped_now_ = 0, clipped_ = 0;
    Real liquid_volume_error_ = 0;
    Vec3 on_liquid_, on_solids_; // [N s]
    Real sizes_ = 0;             // [N s]
};

} // namespace mpsdem::coupling
