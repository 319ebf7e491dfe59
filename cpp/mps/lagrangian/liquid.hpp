#pragma once

#include "mps/gradient.hpp"
#include "mps/kind.hpp"
#include "mps/lagrangian/bore.hpp"
#include "mps/lagrangian/ends.hpp"
#include "mps/lagrangian/pressure_equation.hpp"
#include "mps/load.hpp"
#include "mps/reference_density.hpp"
#include "mps/turbulence.hpp"
#include "mps/wall_function.hpp"

#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace mpsdem::mps::lagrangian {

/// Laminar with a wall that holds the liquid; or an eddy viscosity of some length, with the log law
/// at the wall.
struct Laminar {};
using Flow = std::variant<Laminar, MixingLength, Smagorinsky>;

/// What drives the liquid along the pipe.
struct Drive {
    Real bulk_velocity;                    // [m/s] held each step, unless a gradient is given;
                                           //       scales the background pressure in any case
    std::optional<Real> pressure_gradient; // [Pa/m] loss along the pipe, given
};

/// Numbers of the method, with the values that held in long pipes.
struct Numerics {
    Real particle_spacing;  // [m]
    Real courant = 0.8;     // [-] largest speed * step / spacing
    Real tolerance = 1e-3;  // [-] of the pressure equation's residual
    Real background = 0.02; // [-] p_b over rho U^2
    Real shift = 0.25;      // [-] of the spacing squared, times the gradient of concentration,
                            //     for each spacing that the fastest liquid goes
    Pairing pairing = Pairing::conserving;
    Real pressure_limit = 0.25; // [-] largest |p'| over rho U^2; beyond it, clamped and counted;
                                //     with solids in it, and eight times its scatter
    Real speed = 0; // [m/s] U of the background and of the limit, where solids stir a liquid that
                    //       hardly flows; at least the bulk velocity is taken
    Solver solver = Solver::two_level;
    int threads = 1;
};

/// What a call of Liquid::advance met, over its substeps.
struct AdvanceReport {
    int substeps = 0;
    int halvings = 0; // substeps halved after a failed solve
    SolveTally solve;
    Real mean_gradient = 0; // [Pa/m] loss of pressure along the pipe, mean over the call
    Real friction = 0;      // [Pa/m] that walls and viscosity take up, mean over the call
    Real unexplained = 0;   // [Pa/m] of the axial momentum: what p' does, and in a pipe must not
    Real bending = 0; // [Pa/m] part of mean_gradient: the loss along a moving axis that slopes
    Real convection_error = 0; // [Pa/m] that particles failed to carry along, and were given back
    std::size_t clamped = 0;   // pressures cut to the limit
    std::size_t viscosity_capped = 0; // eddy viscosities cut to what the step can bear
    std::size_t shifts_cut = 0;       // shifts cut to their longest
    std::size_t deficient = 0;        // particles whose neighbors fix no Laplacian: no viscosity
    std::size_t held_back = 0; // particles kept from going nearer to the wall than 0.3 spacings
    std::size_t pushed = 0;    // the same before the plate, which pushes them
    std::size_t plate_returns = 0;
    std::size_t entered = 0;  // particles that came to be behind it
    std::size_t replaced = 0; // particles between plate and bore that went for them
    std::size_t crowded = 0;  // particles left out there, too near to others
    std::size_t left = 0;     // particles that went through the outlet
    bool sound = true;        // false: the pressure could not be solved, or speeds overflowed
};

/// The particle liquid of a full, straight pipe, rigid or bending: MPS proper. The pipe is
/// periodic, or a plate pushes the liquid through it.
///
/// A step finds the neighbors once and takes every operator there:
///
///   u* = u + dt (viscous acceleration + wall shear)
///   lap p' = (rho / dt) div u*      slip wall if turbulent; less its mean and axial long-wave bias
///   u  = u* - dt / rho grad p' + dt G / rho x^
///   x  <- x + dt u + shift
///
/// p' is what is left of the pressure when every uniform acceleration and the mean axial gradient G
/// are split off: in a full rigid pipe these move nothing, so gravity does not enter at all.
/// Between a plate and an outlet the flux through every section is the plate's: G, a function of x,
/// holds the mean velocity of each diameter of length to it, and p' is 0 behind the outlet.
/// Stable where it was measured, but dissipative: of the energy of a swirl of 0.1 U at a Reynolds
/// number of 2e5, 22, 9 and 4 % are left after 5, 10 and 15 R/U at ten spacings across. It is a
/// liquid of the mean flow, not of its eddies. Laminar flow has no such damping: from a Reynolds
/// number of a few hundred on a swirl lives on.
///
/// With solids in it (`Load`), the particles go on to fill the bore evenly and move with the volume
/// flux w = eps u + s, which has no divergence, while the liquid passes them with u - w:
///
///   u* = u + dt (viscous terms + wall shear - (u - w) . grad u)
///   w* = a (eps u* + dt D / rho) + s,    a = 1 / (1 + dt beta / (rho eps))    drag implicit
///   div(a grad p') = (rho / dt) div w*
///   w  = w* + a dt / rho (G - grad p'),  u = (w - s) / eps,  x <- x + dt w + shift
///
/// The viscous terms are div(eps nu grad u) / eps in turbulent flow; in laminar flow nu lap u, as
/// the solids' drag outweighs what it misses. So the number density stays that of the clear liquid,
/// and d(eps)/dt need not be found. G is then a function of x that gives each section back what
/// drag and walls took from its flux.
///
/// Walls that move (`bend`) carry their particles along, each cross-section as one body. All
/// operators see where particles are; what counts from the axis (mixing length, the order in
/// memory, the coarse space of the solver) sees them in the section, as in a straight pipe. The
/// wall's velocity enters the divergence, its shear and the laminar Laplacian. As of every
/// acceleration that is known, that of a plug which follows the axis w(x, t) is split off,
///
///   A = w_tt + 2 U w_xt + U^2 w_xx,   p = p' - rho (A.r + h(x)),  dh/dx = -A.w_x
///
/// r from the axis in the section: u gains (A_x.r, A) dt, whose mean along the pipe is nil, and h
/// counts in the loss of pressure along the axis.
///
/// Sources: Koshizuka & Oka (1996), doi:10.13182/NSE96-A24205; shifting after Xu, Stansby &
/// Laurence (2009), doi:10.1016/j.jcp.2009.05.032.
class Liquid {
public:
    /// Particles as `ring_layout` or `lattice_layout` places them; velocity of the walls is zero.
    /// With a plate, as `push_plate_layout` does: wall and ghosts inside the pipe's radius are it.
    Liquid(std::span<const Vec3> position, std::span<const Vec3> velocity,
           std::span<const Kind> kind, Real pipe_radius, Real pipe_length,
           const std::optional<PushPlate>& plate, Real density, Real kinematic_viscosity,
           Real roughness, Flow flow, const Drive& drive, const Numerics& numerics);

    /// Advance by dt [s], in as few substeps as the Courant number and viscosity allow; `loading`
    /// tells of the solids in the liquid, if there are any. Not with a plate.
    AdvanceReport advance(Real dt, Loading* loading = nullptr);

    /// The pipe moves so in the next advance, which lasts as long; from now on it is where that
    /// begins. Not with a plate.
    void bend(const geometry::Bending& bending);

    /// Drive the liquid otherwise from now on. A plate drives it alone.
    void drive(const Drive& drive);

    /// The liquid's own particles, without wall and ghosts, in one order.
    [[nodiscard]] std::span<const Vec3> liquid_position() const noexcept { // [m]
        return std::span(wall_.straight() ? position_ : place_).first(liquid_count_);
    }
    [[nodiscard]] std::span<const Vec3> liquid_velocity() const noexcept { // [m/s]
        return std::span(velocity_).first(liquid_count_);
    }
    [[nodiscard]] Real period() const noexcept { return ends_.period(); } // [m] 0: none
    /// Of the same: the acceleration by all but the drag of solids, over the last substep.
    [[nodiscard]] std::span<const Vec3> liquid_acceleration() const noexcept { // [m/s2]
        return acceleration_of_last_;
    }
    [[nodiscard]] LiquidPoints points() const noexcept {
        return {liquid_position(), volume_, period()};
    }
    /// Particles there may be: each has its place in the arrays below, in the order they were
    /// given. A place that no particle holds at the moment is liquid, with NaN for a position.
    [[nodiscard]] std::size_t places() const noexcept { return places_; }
    [[nodiscard]] std::size_t liquid_count() const noexcept { return liquid_count_; }
    [[nodiscard]] std::size_t count_in_bore() const;
    [[nodiscard]] Real plate_face() const noexcept { return ends_.face(); } // [m]
    [[nodiscard]] std::vector<Vec3> position() const; // [m] in the order they were given
    [[nodiscard]] std::vector<Vec3> velocity() const; // [m/s]
    [[nodiscard]] std::vector<Kind> kind() const;
    [[nodiscard]] std::vector<Real> pressure() const;      // [Pa] p'
    [[nodiscard]] std::vector<Real> density_ratio() const; // [-] n / mean n, as they lie now
    [[nodiscard]] std::vector<Real> void_fraction() const; // [-] of the last substep
    [[nodiscard]] Real bulk_velocity() const; // [m/s] flow rate of liquid and solids over the bore
    [[nodiscard]] Real pressure_gradient() const noexcept { return gradient_; } // [Pa/m] last step
    [[nodiscard]] Real wall_shear() const noexcept { return wall_shear_; }      // [Pa] mean
    [[nodiscard]] Real kinetic_energy() const;                                  // [J/kg] per mass
    [[nodiscard]] Real density_scatter() const; // [-] standard deviation over the mean
    [[nodiscard]] Real pressure_noise() const noexcept {
        return pressure_noise_;
    } // [Pa] rms change

    /// Exact state but for the drive; restoring it continues bit-equal.
    struct Snapshot {
        std::vector<Vec3> position, velocity;
        std::vector<Real> pressure;
        std::vector<Index> id;
        std::vector<Real> ends;
        std::vector<Vec3> acceleration, flux; // of the liquid alone, where solids load it
        std::vector<Real> void_fraction;
    };
    [[nodiscard]] Snapshot snapshot() const {
        return {position_,    velocity_, pressure_, id_, ends_.state(), acceleration_of_last_,
                volume_flux_, eps_};
    }
    void restore(const Snapshot& snapshot);

private:
    [[nodiscard]] bool turbulent() const noexcept {
        return !std::holds_alternative<Laminar>(flow_);
    }
    [[nodiscard]] Real dynamic_pressure() const noexcept; // [Pa] rho U^2
    [[nodiscard]] std::size_t size() const noexcept { return position_.size(); }
    /// Where particles are; `position_` in their section, if the pipe is bent.
    [[nodiscard]] const std::vector<Vec3>& places_now() const noexcept {
        return wall_.straight() ? position_ : place_;
    }
    /// Velocity from that of the wall in the same section [m/s].
    [[nodiscard]] Vec3 from_wall(std::size_t i, const Vec3& velocity) const noexcept {
        return wall_.straight() ? velocity : velocity - wall_.axis(position_[i].x).velocity;
    }
    [[nodiscard]] std::size_t solids() const noexcept { return size() - liquid_count_; }
    /// Whether a particle is liquid that its forces move.
    [[nodiscard]] bool moves(std::size_t i) const noexcept {
        return i < liquid_count_ && ends_.inside(position_[i]);
    }
    template <class Value>
    [[nodiscard]] Real mean_in_bore(const Value& value) const;
    template <class Flux>
    [[nodiscard]] AxialBins flux_of_sections(const Flux& flux) const;
    /// Length of pipe over which the flux is held: solids part it along the pipe [m].
    [[nodiscard]] Real section_length() const noexcept {
        return 2 * (loaded() ? numerics_.particle_spacing : pipe_radius_);
    }
    [[nodiscard]] Real flux_before(std::size_t i) const noexcept;
    template <class Holds>
    [[nodiscard]] std::size_t count_liquid(const Holds& holds) const;
    [[nodiscard]] Real fastest() const; // [m/s]
    [[nodiscard]] Real stable_step() const;
    [[nodiscard]] bool step(Real dt, AdvanceReport& report, Loading* loading, Real elapsed);
    void bend_to(Real elapsed);
    void follow_axis(Real dt, Real elapsed);
    void sort();
    [[nodiscard]] neighbors::Groups groups() const;
    void find_pairs();
    void predict(Real dt, AdvanceReport& report);
    void find_eddy_viscosity(Real dt, AdvanceReport& report);
    void add_wall_shear();
    [[nodiscard]] bool solve_pressure(Real dt, AdvanceReport& report);
    void find_known();
    void remove_axial_bias();
    [[nodiscard]] std::vector<Real> number_ratio() const;
    void cut_pressure(AdvanceReport& report);
    void extrapolate_pressure();
    void smooth_beside_plate();
    void correct(Real dt, const AxialBins& before);
    void hold_bulk_velocity(Real dt);
    void hold_flux_of_plate(Real dt, const AxialBins& before);
    void move(Real dt, AdvanceReport& report, Real elapsed);
    [[nodiscard]] bool loaded() const noexcept { return !load_.empty(); }
    [[nodiscard]] Real liquid_share(std::size_t i) const noexcept;
    [[nodiscard]] bool outruns(Real dt) const;
    [[nodiscard]] Real mean_momentum() const;
    [[nodiscard]] Real add_relative_convection(Real dt);
    void take_load(Real dt, Real brought);
    void hold_sections(Real dt, const AxialBins& before);
    void leave_load(Real dt, Loading& loading);
    void move_plate(Real dt, AdvanceReport& report);
    void keep(const std::vector<std::uint8_t>& kept);
    void enter(std::span<const Entrant> entrants);
    void resize_liquid(std::size_t count);

    Ends ends_;
    Bore wall_;
    geometry::Bending bending_;
    Real pipe_radius_, pipe_length_; // [m]
    Real density_;                   // [kg/m3]
    Real viscosity_;                 // [m2/s] kinematic
    Flow flow_;
    Drive drive_;
    Numerics numerics_;
    ReferenceDensity reference_;
    WallFunction wall_function_;
    StoredPairs pairs_;
    neighbors::Cells cells_; // over all particles at the start: pipe and plate's stroke
    neighbors::CellGrid grid_;
    PressureEquation pressure_equation_;

    // Particles in the order liquid, wall, ghosts, each sorted by cells; walls and ghosts for good.
    std::size_t liquid_count_ = 0, wall_count_ = 0, places_ = 0;
    std::vector<Vec3> position_, velocity_;
    std::vector<Vec3> place_; // [m] where they are if the pipe is bent; else not used
    std::vector<Kind> kind_;
    std::vector<Real> pressure_; // [Pa] p'
    std::vector<Index> id_;      // place in the order they were given

    // Of each ghost, the wall particles in reach, by their places among the walls.
    std::vector<Index> behind_first_, behind_column_;
    std::vector<Real> behind_share_; // [-] of their pressures

    // Memory of a step.
    std::vector<Vec3> acceleration_, shift_, velocity_before_;
    std::vector<Vec3> plug_; // [m/s] of one that follows a moving axis, at the end of the substep
    std::vector<Real> scalar_, eddy_viscosity_, right_hand_side_, pressure_before_, known_;
    std::vector<std::uint8_t> deficient_;
    std::vector<Index> order_, id_memory_;

    // Of the liquid with solids in it; empty while there were none.
    Load load_;                              // of the substep under way
    std::vector<Real> volume_;               // [m3] of the bore, of each particle
    std::vector<Real> eps_;                  // [-] void fraction of the last substep
    std::vector<Real> damping_;              // [-] a, of liquid and walls
    std::vector<Vec3> volume_flux_;          // [m/s] w of the last substep
    std::vector<Vec3> acceleration_of_last_; // [m/s2] of the liquid, drag apart
    Real fastest_ = 0;                       // [m/s] of the liquid, at the substep's start
    Real convection_error_ = 0;              // [Pa/m]

    Real bending_loss_ = 0; // [Pa/m] of the last substep, along the axis
    Real gradient_ = 0, friction_ = 0, unexplained_ = 0, wall_shear_ = 0, pressure_noise_ = 0;
};

} // namespace mpsdem::mps::lagrangian
