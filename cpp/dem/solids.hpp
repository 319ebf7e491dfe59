#pragma once

#include "dem/hertz_mindlin.hpp"
#include "dem/hertz_viscoelastic.hpp"
#include "dem/linear_spring.hpp"
#include "dem/lubrication.hpp"
#include "dem/pair_list.hpp"
#include "dem/rolling_resistance.hpp"
#include "dem/wall_contact.hpp"
#include "geometry/wall.hpp"
#include "neighbors/cell_grid.hpp"

#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace mpsdem::dem {

using AnyContactLaw = std::variant<LinearSpring, HertzMindlin, HertzViscoelastic>;

/// How solids touch each other, or a wall.
struct ContactModel {
    AnyContactLaw law;
    RollingResistance rolling;
    Rolling mode;
};

/// What a call of Solids::advance met.
struct AdvanceReport {
    Real largest_overlap = 0; // [-] over the smaller radius
    std::size_t prunes = 0;   // times the inner lists were made
    std::size_t sorts = 0;    // of these, times the solids were sorted and the outer lists made
    bool finite = true;       // false: positions or velocities overflowed; the state is lost
};

/// Everything that touches at one instant, in the caller's numbering.
struct ContactTable {
    std::vector<std::int64_t> first, second; // second = -1 - w for wall w
    std::vector<Real> overlap;               // [m]
    std::vector<Vec3> normal;                // [-] from second to first
    std::vector<Vec3> force;                 // [N] on first
};

/// Spheres that touch each other and walls: state, lists and the substep loop.
///
/// Two lists: the outer one (cell grid, skin of a fraction of a radius) is filtered into an inner
/// one of pairs that nearly touch. An inner list is valid while twice the summed largest speed,
/// relative to the mean velocity at the last sort, is below its skin, and solids near a wall are
/// listed by the like bound; these bounds are exact, nothing is missed. Where gaps are lubricated,
/// both lists reach farther by the widest such gap.
class Solids {
public:
    Solids(std::span<const Vec3> position, std::span<const Vec3> velocity,
           std::span<const Vec3> spin, std::span<const Real> radius, std::span<const Real> density,
           const ContactModel& between_solids, const ContactModel& at_walls,
           std::vector<geometry::Wall> walls, Real period, int threads,
           const std::optional<Lubrication>& lubrication);

    /// From now on dv/dt = F/m + acceleration + drag_rate (u - v), u = liquid_velocity. With the
    /// last two spans the liquid responds: du/dt = liquid_acceleration - relaxation (u - v), from
    /// liquid_velocity on. `added_mass` (over the solid's own) adds added_mass (du/dt - dv/dt) to
    /// dv/dt. Spans may be empty: no added mass, no response, no drag. Starts `drag_impulse` and
    /// `mean_velocity` anew.
    void set_forcing(std::span<const Vec3> acceleration, std::span<const Vec3> liquid_velocity,
                     std::span<const Real> drag_rate, std::span<const Vec3> liquid_acceleration,
                     std::span<const Real> relaxation, std::span<const Real> added_mass);

    /// Bent walls move so in the next advance; as at its end afterwards.
    void bend(const geometry::Bending& bending);

    /// `steps` steps of velocity Verlet of `dt` [s].
    AdvanceReport advance(Real dt, std::size_t steps);

    [[nodiscard]] std::size_t size() const noexcept { return solids_.size(); }
    [[nodiscard]] std::vector<Vec3> position() const; // [m] in the period
    [[nodiscard]] std::vector<Vec3> velocity() const; // [m/s]
    [[nodiscard]] std::vector<Vec3> spin() const;     // [rad/s]
    [[nodiscard]] std::vector<Real> radius() const;   // [m]
    [[nodiscard]] std::vector<Real> mass() const;     // [kg]
    [[nodiscard]] std::vector<std::int64_t> laps() const;
    /// Longest step that lubrication allows [s]; infinite without.
    [[nodiscard]] Real longest_step() const noexcept;
    /// Of drag and added mass on each solid since set_forcing [N s].
    [[nodiscard]] std::vector<Vec3> drag_impulse() const;
    /// Mean of v over the kicks since set_forcing [m/s]; only in a liquid.
    [[nodiscard]] std::vector<Vec3> mean_velocity() const;
    [[nodiscard]] std::vector<Vec3> liquid_velocity() const; // [m/s] now, at each solid
    [[nodiscard]] Vec3 wall_impulse() const;   // [N s] of walls on solids since the start
    [[nodiscard]] Real kinetic_energy() const; // [J] of translation and spin
    [[nodiscard]] Real elastic_energy() const; // [J]
    [[nodiscard]] ContactTable contacts() const;

    /// The exact state, as two rows of numbers whose layout is private: restoring it continues
    /// bit-equal. Forcing and its sums are not part of it: they stay as they are.
    struct Snapshot {
        std::vector<Real> reals;
        std::vector<std::int64_t> integers;
    };
    [[nodiscard]] Snapshot snapshot() const;
    void restore(const Snapshot& snapshot);

private:
    template <class Choose>
    [[nodiscard]] auto in_medium(const Choose& choose) const;
    void measure(const Lubrication& lubrication);
    void bend_walls(Real elapsed);
    void kick_all(Real dt);
    void move(Real kick_time, Real dt);
    void wall_forces(Block& block, Real dt);
    void lubricate(const Lubrication& lubrication, Block& block);
    void contact_forces(Real dt);
    void update_lists(Real dt, AdvanceReport& report);
    [[nodiscard]] bool sort();
    void build_inner(Block& block);
    void forget_parted();
    void find_near_wall(Block& block, std::size_t w);
    void set_inner_skin(Real skin);
    void link_blocks();
    [[nodiscard]] bool finite() const noexcept;
    void take_forcing(const Solids& from);
    template <class Archive>
    void exchange(Archive& archive);
    template <class Visit>
    void for_each_contact(const Visit& visit) const;
    template <class T, class Value>
    [[nodiscard]] std::vector<T> in_callers_order(const Value& value) const;

    Population solids_;
    std::vector<Block> blocks_;
    std::vector<geometry::Wall> walls_;
    geometry::Bending bending_;
    Real wall_speed_ = 0; // [m/s] of bent walls, at most
    Real wall_slope_ = 0; // [-] of their axis, at most
    std::vector<WallHistory> at_wall_;
    ContactModel pair_model_, wall_model_;
    std::optional<Lubrication> lubrication_;
    Real pair_reach_ = 0, wall_reach_ = 0; // [m] widest lubricated gap, 0: none
    Real lubrication_rate_ = 0;            // [1/s] fastest at which it slows a pair
    Real period_;                          // [m], 0: none
    int threads_;
    Real mean_radius_, max_radius_; // [m]
    Medium medium_ = Medium::dry;
    Real forcing_time_ = 0; // [s] summed kicks since set_forcing

    neighbors::CellGrid grid_{1, 0};
    Vec3 frame_velocity_;    // [m/s] mean at the last sort
    Real frame_time_ = 0;    // [s] since the last sort
    Real approach_ = 0;      // [m] by which pairs may have closed since the last prune
    Real wall_approach_ = 0; // [m] the same of a solid and a wall
    Real wall_drift_ = 0;    // [m/s] of the frame towards walls
    Real outer_skin_ = 0, inner_skin_ = 0; // [m]
    Real wall_skin_ = 0;                   // [m] gap below which a wall lists a solid
    Real fastest_ = 0;                     // [m/s] largest speed relative to the frame, last step
};

} // namespace mpsdem::dem
