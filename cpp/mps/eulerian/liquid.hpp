#pragma once

#include "core/parallel.hpp"
#include "linear/cross_section_solver.hpp"
#include "mps/eulerian/carry_muscl.hpp"
#include "mps/eulerian/carry_upwind.hpp"
#include "mps/eulerian/loaded.hpp"
#include "mps/eulerian/section.hpp"
#include "mps/eulerian/stencil.hpp"
#include "mps/eulerian/wall_law.hpp"
#include "mps/load.hpp"

#include <optional>
#include <span>
#include <vector>

namespace mpsdem::mps::eulerian {

enum class Flow { laminar, turbulent };
enum class Convection { upwind, muscl };
enum class Scheme { rk2, rk3 };

/// What drives the liquid along the pipe.
struct Drive {
    Real bulk_velocity;                    // [m/s] held at every stage, unless a gradient is given
    std::optional<Real> pressure_gradient; // [Pa/m] loss along the pipe, given
};

/// What bounds a step.
enum class Limit { none, courant, viscosity };

/// Numbers of the method.
struct Numerics {
    std::size_t stations; // along the pipe, a multiple of 4
    Real courant;         // [-] largest (|u_x| / axial spacing + speed across / spacing) * step
    Convection convection = Convection::upwind;
    Scheme scheme = Scheme::rk2;
    int threads = 1;
};

/// What a call of Liquid::advance met, over its substeps.
struct AdvanceReport {
    int substeps = 0;
    Limit limit = Limit::none; // what bound the shortest step; none: one step took all
    Real shortest = 0;         // [s] the least step allowed
    Real mean_gradient = 0;    // [Pa/m] loss of pressure along the pipe, mean over the call
    Real friction = 0;         // [Pa/m] that the walls take up, mean over the call; turbulent only
    Real unexplained = 0;      // [Pa/m] of the axial momentum; turbulent only
    Real convection_error = 0; // [Pa/m] of the axial momentum between solids, given back
    Real divergence = 0;       // [-] rms of div u, times spacing over the largest speed, at the end
    Real solve_seconds = 0;    // [s] in the pressure equation
    bool sound = true;         // false: speeds overflowed, or the step became too short
};

/// The liquid of a full, straight, rigid, periodic round pipe on fixed nodes: least-squares MPS
/// with its particles held on rings that repeat along the pipe.
///
/// Runge-Kutta stages in the form of Shu & Osher, each of them made free of divergence:
///
///   u* = a u^0 + (1 - a) (u + dt (viscous + body force - u . grad u))
///   lap phi = div u*,   n . grad phi = n . u* on the wall,   p = rho phi / ((1 - a) dt)
///   u  = u* - grad phi + what holds the bulk velocity, or what the given gradient adds
///
/// Laminar flow sticks to the wall; turbulent flow has Nikuradse's mixing length and `WallLaw`, and
/// in each plane a force on the layer next to the wall makes the viscous terms sum to the wall's
/// shear. A liquid of the mean flow. Operators across the pipe are stored for one plane.
///
/// With solids in it (`Load`), the momentum per volume m = eps u takes the place of u in the
/// projection, with the same pressure matrix; the pressure p is kept, and one substep is
///
///   m* = [eps (u + dt H) + dt (D / rho + G / rho x^ - grad p / rho)] / (1 + dt beta / (rho eps))
///   lap phi = div(m* + s),   n . grad phi = n . m* on the wall,   p += rho phi / dt
///   m  = m* - grad phi + what holds the flux of the mixture, which goes into G
///
/// H are convection and viscosity, div(eps nu grad u) / eps, in Adams and Bashforth's second order:
/// a pressure of Runge and Kutta's stages would have to be found without the drag's damping, and
/// without the pressure of the step before a stiff bed would lose its drag. The pressure within a
/// bed of C = dt beta / (rho eps) is found in about C steps. Within a Courant number of 0.45.
///
/// Every field is [node][station].
///
/// Sources: Shu & Osher (1988), doi:10.1016/0021-9991(88)90177-5; Tamai & Koshizuka (2014),
/// doi:10.1007/s40571-014-0027-2; Chorin (1968), doi:10.1090/S0025-5718-1968-0242392-2.
class Liquid {
public:
    /// Velocities are [node][station]; those on the wall are set here.
    Liquid(const Section& section, Real pipe_length, std::span<const Vec3> velocity, Real density,
           Real kinematic_viscosity, Real roughness, Flow flow, const Drive& drive,
           const Numerics& numerics);

    /// Advance by dt [s], in as few equal substeps as Courant number and viscosity allow; `loading`
    /// tells of the solids in the liquid, if there are any. Not with a body force or a source.
    AdvanceReport advance(Real dt, Loading* loading = nullptr);

    /// Drive the liquid otherwise from now on.
    void drive(const Drive& drive) { drive_ = drive; }
    /// Acceleration of every mass, as of a shaken pipe or of gravity [m/s2].
    void body_force(const Vec3& acceleration) { body_force_ = acceleration; }
    /// Force on the liquid over its mass at every node, [node][station], from now on; none: empty.
    void momentum_source(std::span<const Vec3> acceleration); // [m/s2]

    [[nodiscard]] const Section& section() const noexcept { return section_; }
    [[nodiscard]] std::size_t stations() const noexcept { return numerics_.stations; }
    [[nodiscard]] Real axial_spacing() const noexcept { return axial_.spacing; } // [m]
    [[nodiscard]] Real pipe_length() const noexcept { return pipe_length_; }     // [m]
    [[nodiscard]] std::size_t size() const noexcept { return section_.size() * stations(); }
    [[nodiscard]] const VectorField& velocity() const noexcept { return u_; } // [m/s]
    [[nodiscard]] std::vector<Real> pressure() const;  // [Pa] less its mean; [node][station]
    [[nodiscard]] std::vector<Real> viscosity() const; // [m2/s] eddies' too, of the last stage
    [[nodiscard]] Real bulk_velocity() const;          // [m/s] mean over the bore
    [[nodiscard]] Real pressure_gradient() const noexcept { return gradient_; } // [Pa/m] last step
    [[nodiscard]] Real wall_shear() const;     // [Pa] mean of the wall law; 0 in laminar flow
    [[nodiscard]] Real kinetic_energy() const; // [J/kg] per mass
    [[nodiscard]] Real pressure_noise() const; // [Pa] scatter of p about its mean
    [[nodiscard]] Real largest_viscosity() const noexcept { return largest_viscosity_; } // [m2/s]

    /// As solids see the liquid: its inner nodes, [node][station], which share the bore.
    [[nodiscard]] LiquidPoints points();
    [[nodiscard]] std::span<const Vec3> interior_velocity();                     // [m/s]
    [[nodiscard]] std::span<const Vec3> interior_acceleration() const noexcept { // [m/s2]
        return loaded_ ? std::span<const Vec3>(loaded_->acceleration) : std::span<const Vec3>();
    }
    [[nodiscard]] std::vector<Real> void_fraction() const; // [-] of the last substep

    /// Exact state; restoring it continues bit-equal.
    struct Snapshot {
        std::vector<Vec3> velocity;
        std::vector<Real> pressure, friction_velocity, drag;
        Real gradient = 0;
        std::vector<Real> loaded; // all that solids in it add; empty without
    };
    [[nodiscard]] Snapshot snapshot() const;
    void restore(const Snapshot& snapshot);

private:
    struct Stage {
        Real kept; // [-] a, the share of the step's start
        Real dt;   // [s]
    };

    /// Volume flux of liquid and solids over the bore, and what of it an impulse of 1 m/s along the
    /// pipe, spread evenly over the bore, adds.
    struct MixtureFlux {
        Real velocity; // [m/s]
        Real yield;    // [-]
    };
    /// Mean over the inner nodes of what `row` sums up over the stations of one.
    template <class Row>
    [[nodiscard]] Real interior_mean(const Row& row) const {
        of_node_.resize(section_.interior_count());
        parallel_for(of_node_.size(), numerics_.threads,
                     [&](std::size_t i) { of_node_[i] = section_.area(i) * row(i); });
        return total(of_node_) / (interior_area_ * static_cast<Real>(stations()));
    }

    void transport();
    [[nodiscard]] Real viscous_limit_loaded() const;
    [[nodiscard]] Real allowed(bool with_solids, AdvanceReport& report);
    void predict(const Stage& stage);
    void project(const Stage& stage, AdvanceReport& report);
    [[nodiscard]] Real correct(Real kick);
    void meet_wall(std::size_t begin, std::size_t end);
    void take_load(const Load& load, Loaded& on) const;
    [[nodiscard]] Real interior_momentum(const Loaded& on) const;
    void step_with_solids(Real dt, Loading& loading, Real elapsed, Real share,
                          AdvanceReport& report);
    void find_rates(Loaded& on);
    void find_wall_drag(Loaded& on, std::size_t begin, std::size_t end) const;
    [[nodiscard]] Real stiffness(const Loaded& on, Real dt) const;
    [[nodiscard]] Real correct_with_solids(Loaded& on, Real dt);
    [[nodiscard]] Real settle_with_solids(Loaded& on, Real dt, std::span<const Vec3> owed);
    [[nodiscard]] MixtureFlux mixture_flux(const Loaded& on) const;
    void find_volume_flux(const Loaded& on, VectorField& flux) const;
    void find_divergence(const VectorField& field, Field& result);
    [[nodiscard]] Real residual_divergence();
    [[nodiscard]] Real mean_drag() const;
    [[nodiscard]] Real mean_interior_velocity() const;
    [[nodiscard]] Real flux(const Field& velocity, std::size_t nodes) const;
    [[nodiscard]] Real source_velocity_rate() const;

    Section section_;
    Real pipe_length_; // [m]
    Axial axial_;
    Chunks chunks_;
    Real density_;   // [kg/m3]
    Real viscosity_; // [m2/s] kinematic, molecular
    Flow flow_;
    Drive drive_;
    Numerics numerics_;
    WallLaw wall_law_;
    MixingLength mixing_length_;
    Stencil<2> gradient_stencil_;
    Stencil<1> laplacian_stencil_;
    Stencil<4> upwind_stencil_;
    Real viscous_bound_; // [1/m2] largest eigenvalue of the Laplacian, from above
    Real bore_area_, interior_area_, layer_area_; // [m2]
    linear::CrossSectionSolver solver_;

    VectorField u_, start_, star_;           // [m/s]; star_ holds accelerations before `predict`
    VectorField source_;                     // [m/s2] of the nodes; empty where there is none
    Gradients gradients_;                    // only for MUSCL
    Field strain_, nu_t_;                    // [1/s2], [m2/s] all viscosity
    Field phi_;                              // [m2/s]
    Field friction_velocity_;                // [m/s] of the wall's nodes
    std::vector<Real> drag_;                 // [m3/s2] of the wall, by station
    std::vector<Real> flux_, viscous_force_; // by station
    std::vector<Real> of_chunk_;
    mutable std::vector<Real> of_node_; // memory of a sum
    mutable std::vector<MixtureFlux> of_wall_;
    std::optional<Loaded> loaded_;
    std::vector<Vec3> interior_position_, interior_velocity_; // [m], [m/s] as solids see them
    std::vector<Real> interior_volume_;                       // [m3]
    std::vector<Real> convection_; // [m3/s2] of momentum, by station; memory of a step
    Vec3 body_force_;              // [m/s2]
    Real pressure_scale_ = 0;      // [kg/m3/s] p over phi
    Real gradient_ = 0, largest_viscosity_ = 0;
};

} // namespace mpsdem::mps::eulerian
