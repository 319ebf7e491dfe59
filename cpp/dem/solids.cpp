#include "dem/solids.hpp"

#include "core/parallel.hpp"
#include "dem/integrator.hpp"
#include "dem/lubrication_forces.hpp"
#include "dem/pair_contact.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

namespace mpsdem::dem {

namespace {

using P = Population;

// List settings change speed only, never the forces beyond the order of their sums.
constexpr std::size_t single_block = 4096; // [-] solids that one thread handles faster than two
constexpr std::size_t block_size = 2048;   // [-]
constexpr Real inner_steps = 8;            // [-] steps that an inner list should last
constexpr Real least_inner_skin = 0.005;   // [-] over the mean radius
constexpr Real outer_steps = 400;          // [-] steps that an outer list should last
constexpr Real least_outer_skin = 0.25, most_outer_skin = 0.8; // [-] over the mean radius

// Damping at the last half step's velocity: 2 is the limit of a lone pair; a solid squeezed by
// twelve equal ones that move against it is slowed four times as fast.
constexpr Real most_lubrication = 0.5; // [-] step times rate

constexpr Real most_laps = 1 << 30; // [-] beyond it a solid is lost: laps are whole numbers

/// Where x lies within the period, and after how many periods.
struct Lap {
    Real x;     // [m]  in [0, period), whatever the rounding
    Real count; // [-]  whole

    Lap(Real unwrapped, Real period) : count(std::floor(unwrapped / period)) {
        x = std::max(unwrapped - count * period, 0.);
        if (x >= period) {
            x = 0;
            ++count;
        }
        // a lost solid may be anywhere: finite() tells
        count = std::isnan(count) ? 0 : std::clamp(count, -most_laps, most_laps);
    }
};

/// A touching pair on its way from one order of the solids to the next.
struct Carried {
    Index partner;
    std::int32_t image;
    History history;
};

} // namespace

Solids::Solids(std::span<const Vec3> position, std::span<const Vec3> velocity,
               std::span<const Vec3> spin, std::span<const Real> radius,
               std::span<const Real> density, const ContactModel& between_solids,
               const ContactModel& at_walls, std::vector<geometry::Wall> walls, Real period,
               int threads, const std::optional<Lubrication>& lubrication)
    : solids_(position.size()), walls_(std::move(walls)), pair_model_(between_solids),
      wall_model_(at_walls), lubrication_(lubrication), period_(period), threads_(threads) {
    const std::size_t n = position.size();
    require(n > 0, "Solids: at least one solid is needed");
    require(velocity.size() == n && spin.size() == n && radius.size() == n && density.size() == n,
            "Solids: position, velocity, spin, radius and density must have the same length");
    require(threads >= 1, "Solids: threads must be >= 1");
    require(period >= 0 && std::isfinite(period),
            "Solids: period must be >= 0 m and finite (0: not periodic)");
    for (std::size_t i = 0; i < n; ++i) {
        require(radius[i] > 0 && std::isfinite(radius[i]),
                "Solids: radius must be > 0 m and finite");
        require(density[i] > 0 && std::isfinite(density[i]),
                "Solids: density must be > 0 kg/m3 and finite");
        *solids_.at(P::RADIUS, i) = radius[i];
        const Real volume = 4. / 3 * std::numbers::pi * radius[i] * radius[i] * radius[i];
        *solids_.at(P::INVERSE_MASS, i) = 1 / (density[i] * volume);
        solids_.set(P::X, i, position[i]);
        solids_.set(P::VX, i, velocity[i]);
        solids_.set(P::SX, i, radius[i] * spin[i]);
        solids_.id()[i] = static_cast<Index>(i);
    }
    require(finite(), "Solids: position, velocity and spin must be finite");
    max_radius_ = *std::max_element(radius.begin(), radius.end());
    mean_radius_ = std::accumulate(radius.begin(), radius.end(), 0.) / static_cast<Real>(n);
    require(period == 0 || period >= 4 * max_radius_,
            "Solids: period must be at least two diameters of the largest solid, else a solid "
            "touches its own image");
    for (const geometry::Wall& wall : walls_) {
        const Real curvature = std::visit([](const auto& w) { return w.curvature(); }, wall);
        require(-2 * curvature * max_radius_ < 1, "Solids: radius must be less than the bore's");
    }
    if (lubrication_) measure(*lubrication_);

    const std::size_t size = n <= single_block ? n : block_size;
    for (std::size_t begin = 0; begin < n; begin += size) {
        Block block;
        block.begin = begin;
        block.end = std::min(begin + size, n);
        block.near_wall.resize(walls_.size());
        blocks_.push_back(std::move(block));
    }
    at_wall_.assign(walls_.size(), {AlignedVector<Real>(n * WallHistory::record)});
    [[maybe_unused]] const bool sorted = sort();
    // forces of the first half kick; no displacement is added
    contact_forces(0);
}

/// How far and how fast lubrication acts at most. For a pair, reduced radius over reduced mass is a
/// mean of the two solids' radius over mass.
void Solids::measure(const Lubrication& lubrication) {
    pair_reach_ = lubrication.reach(max_radius_ / 2);
    Real most = 0; // [m/kg]
    for (std::size_t i = 0; i < size(); ++i) {
        const Real radius = *solids_.at(P::RADIUS, i);
        const Real inverse_mass = *solids_.at(P::INVERSE_MASS, i);
        most = std::max(most, radius * inverse_mass);
        for (const geometry::Wall& wall : walls_) {
            const Real curvature = std::visit([](const auto& w) { return w.curvature(); }, wall);
            const Real reduced_radius = radius / (1 + curvature * radius);
            wall_reach_ = std::max(wall_reach_, lubrication.reach(reduced_radius));
            most = std::max(most, reduced_radius * inverse_mass);
        }
    }
    lubrication_rate_ = lubrication.rate(most);
}

void Solids::set_forcing(std::span<const Vec3> acceleration, std::span<const Vec3> liquid_velocity,
                         std::span<const Real> drag_rate, std::span<const Vec3> liquid_acceleration,
                         std::span<const Real> relaxation, std::span<const Real> added_mass) {
    const std::size_t n = size();
    require(acceleration.size() == n, "set_forcing: acceleration must have shape (n, 3)");
    require(liquid_velocity.size() == drag_rate.size() &&
                (drag_rate.empty() || drag_rate.size() == n),
            "set_forcing: liquid_velocity (n, 3) and drag_rate (n,) come together");
    require(liquid_acceleration.size() == relaxation.size() &&
                (relaxation.empty() || relaxation.size() == drag_rate.size()),
            "set_forcing: liquid_acceleration (n, 3) and relaxation (n,) come together, and with "
            "drag_rate");
    require(added_mass.empty() || added_mass.size() == drag_rate.size(),
            "set_forcing: added_mass (n,) comes with drag_rate");
    for (const Real k : drag_rate) require(!(k < 0), "set_forcing: drag_rate must be >= 0 1/s");
    for (const Real l : relaxation) require(!(l < 0), "set_forcing: relaxation must be >= 0 1/s");
    for (const Real c : added_mass) require(!(c < 0), "set_forcing: added_mass must be >= 0");
    // added mass needs the acceleration of the liquid, were it zero
    medium_ = drag_rate.empty()                          ? Medium::dry
              : relaxation.empty() && added_mass.empty() ? Medium::liquid
                                                         : Medium::responding_liquid;
    const bool responds = medium_ == Medium::responding_liquid;
    if (responds) solids_.add_response();
    forcing_time_ = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Index id = solids_.id()[i];
        const Real k = drag_rate.empty() ? 0 : drag_rate[id];
        const Vec3 u = drag_rate.empty() ? Vec3{} : liquid_velocity[id];
        solids_.set(P::AX, i, responds ? acceleration[id] : acceleration[id] + k * u);
        solids_.set(P::UX, i, u);
        *solids_.at(P::DRAG, i) = k;
        solids_.set(P::PX, i, {});
        if (!responds) continue;
        solids_.set(P::BX, i, relaxation.empty() ? Vec3{} : liquid_acceleration[id]);
        *solids_.at(P::RELAXATION, i) = relaxation.empty() ? 0 : relaxation[id];
        solids_.set(P::JX, i, {});
        *solids_.at(P::ADDED_MASS, i) = added_mass.empty() ? 0 : added_mass[id];
    }
}

Real Solids::longest_step() const noexcept {
    return most_lubrication / lubrication_rate_;
}

void Solids::bend(const geometry::Bending& bending) {
    bending_ = bending;
    bend_walls(0);
}

void Solids::bend_walls(Real elapsed) {
    if (bending_.straight()) return;
    const geometry::Bend now = bending_.at(elapsed);
    wall_speed_ = now.most_speed();
    wall_slope_ = now.most_slope();
    for (geometry::Wall& wall : walls_)
        if (auto* bent = std::get_if<geometry::BentCylinder>(&wall)) bent->bend(now);
}

AdvanceReport Solids::advance(Real dt, std::size_t steps) {
    require(dt > 0, "advance: dt must be > 0 s");
    require(
        !lubrication_ || dt <= longest_step() * (1 + 1e-9),
        "advance: dt must be <= " + std::to_string(1e6 * longest_step()) +
            "e-6 s, half the time in which lubrication slows a solid at its least_gap, and is " +
            std::to_string(1e6 * dt) + "e-6 s; take shorter steps or a wider least_gap");
    AdvanceReport report;
    for (Block& block : blocks_) block.largest_overlap = 0;
    for (std::size_t step = 0; step < steps; ++step) {
        move(step == 0 ? dt / 2 : dt, dt); // the kick closes the step before, too
        bend_walls(static_cast<Real>(step + 1) * dt);
        update_lists(dt, report);
        if (!report.finite) return report;
        contact_forces(dt);
    }
    if (steps > 0) kick_all(dt / 2);
    for (const Block& block : blocks_)
        report.largest_overlap = std::max(report.largest_overlap, block.largest_overlap);
    report.finite = finite();
    return report;
}

/// choose<medium>() for the medium at hand.
template <class Choose>
auto Solids::in_medium(const Choose& choose) const {
    switch (medium_) {
    case Medium::liquid:
        return choose.template operator()<Medium::liquid>();
    case Medium::responding_liquid:
        return choose.template operator()<Medium::responding_liquid>();
    case Medium::dry:
        break;
    }
    return choose.template operator()<Medium::dry>();
}

void Solids::kick_all(Real dt) {
    forcing_time_ += dt;
    const auto run = in_medium([]<Medium medium> {
        return static_cast<void (*)(Population&, std::size_t, std::size_t, Real)>(&kick<medium>);
    });
    parallel_for_blocks(blocks_.size(), threads_, [&](std::size_t b) {
        Block& block = blocks_[b];
        run(solids_, block.begin, block.end, dt);
        block.wall_impulse += dt * block.wall_force;
    });
}

void Solids::move(Real kick_time, Real dt) {
    forcing_time_ += kick_time;
    const auto run = in_medium([]<Medium medium> { return &kick_and_drift<medium>; });
    parallel_for_blocks(blocks_.size(), threads_, [&](std::size_t b) {
        Block& block = blocks_[b];
        block.wall_impulse += kick_time * block.wall_force;
        block.wall_force = {};
        block.fastest2 = run(solids_, block.begin, block.end, kick_time, dt, frame_velocity_);
    });
}

void Solids::wall_forces(Block& block, Real dt) {
    for (std::size_t w = 0; w < walls_.size(); ++w) {
        if (block.near_wall[w].empty()) continue;
        std::visit(
            [&](const auto& law, const auto& wall) {
                const auto run = wall_model_.mode == Rolling::free
                                     ? &wall_contact<Rolling::free, std::decay_t<decltype(law)>,
                                                     std::decay_t<decltype(wall)>>
                                     : &wall_contact<Rolling::resisted, std::decay_t<decltype(law)>,
                                                     std::decay_t<decltype(wall)>>;
                run(law, wall_model_.rolling, wall, solids_, block, block.near_wall[w], at_wall_[w],
                    dt);
            },
            wall_model_.law, walls_[w]);
    }
}

void Solids::lubricate(const Lubrication& lubrication, Block& block) {
    lubricate_pairs(lubrication, pair_reach_, solids_, block);
    for (std::size_t w = 0; w < walls_.size(); ++w)
        std::visit(
            [&](const auto& wall) {
                lubricate_wall(lubrication, wall_reach_, wall, solids_, block, block.near_wall[w]);
            },
            walls_[w]);
}

void Solids::contact_forces(Real dt) {
    parallel_for_blocks(blocks_.size(), threads_, [&](std::size_t b) {
        wall_forces(blocks_[b], dt);
        std::visit(
            [&](const auto& law) {
                const auto run =
                    pair_model_.mode == Rolling::free
                        ? &pair_contact<Rolling::free, std::decay_t<decltype(law)>>
                        : &pair_contact<Rolling::resisted, std::decay_t<decltype(law)>>;
                run(law, pair_model_.rolling, solids_, blocks_[b], dt);
            },
            pair_model_.law);
        if (lubrication_) lubricate(*lubrication_, blocks_[b]);
    });
    if (blocks_.size() > 1) {
        parallel_for_blocks(blocks_.size(), threads_,
                            [&](std::size_t b) { apply_incoming(solids_, blocks_, blocks_[b]); });
    }
}

void Solids::update_lists(Real dt, AdvanceReport& report) {
    Real fastest2 = 0;
    for (const Block& block : blocks_) fastest2 = std::max(fastest2, block.fastest2);
    fastest_ = std::sqrt(fastest2);
    frame_time_ += dt;
    approach_ += 2 * fastest_ * dt;
    // a sloping wall nears by what goes along the pipe, too
    wall_approach_ += (fastest_ + wall_drift_ + wall_speed_) * (1 + wall_slope_) * dt;
    if (approach_ <= inner_skin_ && wall_approach_ <= wall_skin_) return;

    ++report.prunes;
    forget_parted();
    parallel_for_blocks(blocks_.size(), threads_, [&](std::size_t b) {
        Block& block = blocks_[b];
        block.displacement2 = 0;
        const Vec3 shift = frame_time_ * frame_velocity_;
        for (std::size_t i = block.begin; i < block.end; ++i) {
            const Vec3 moved = solids_.vector(P::X, i) - solids_.vector(P::X0, i) - shift;
            block.displacement2 = std::max(block.displacement2, dot(moved, moved));
        }
    });
    Real displacement2 = 0;
    for (const Block& block : blocks_) displacement2 = std::max(displacement2, block.displacement2);
    const Real left = outer_skin_ - 2 * std::sqrt(displacement2);
    set_inner_skin(std::clamp(2 * fastest_ * dt * inner_steps, least_inner_skin * mean_radius_,
                              outer_skin_ / 2));
    if (left >= inner_skin_) {
        parallel_for_blocks(blocks_.size(), threads_,
                            [&](std::size_t b) { build_inner(blocks_[b]); });
        link_blocks();
        return;
    }
    ++report.sorts;
    outer_skin_ = std::clamp(2 * fastest_ * dt * outer_steps, least_outer_skin * mean_radius_,
                             most_outer_skin * mean_radius_);
    set_inner_skin(std::min(inner_skin_, outer_skin_ / 2));
    report.finite = sort();
}

/// Start new inner lists. At present speeds both last equally long; a frame that moves towards a
/// wall needs a wider skin there.
void Solids::set_inner_skin(Real skin) {
    inner_skin_ = skin;
    const Real towards = (wall_drift_ + wall_speed_) * (1 + wall_slope_);
    const Real drift = towards * skin / (2 * std::max(fastest_, 1e-3 * towards + 1e-300));
    wall_skin_ = skin / 2 + std::min(drift, mean_radius_);
    approach_ = wall_approach_ = 0;
}

bool Solids::sort() {
    const std::size_t n = size();
    if (!finite()) return false;
    outer_skin_ = std::max(outer_skin_, least_outer_skin * mean_radius_);

    std::vector<std::int32_t> wraps(n);
    if (period_ > 0) {
        for (std::size_t i = 0; i < n; ++i) {
            const Lap lap(*solids_.at(P::X, i), period_);
            *solids_.at(P::X, i) = lap.x;
            wraps[i] = static_cast<std::int32_t>(lap.count);
            solids_.laps()[i] += wraps[i];
        }
    }

    const Real reach = 2 * max_radius_ + (outer_skin_ + pair_reach_);
    grid_ = neighbors::CellGrid(reach, period_);
    std::vector<Index> order;
    std::vector<Vec3> position(n);
    for (std::size_t i = 0; i < n; ++i) position[i] = solids_.vector(P::X, i);
    grid_.sort(position, order);
    std::vector<Index> place(n); // where a solid goes
    for (std::size_t k = 0; k < n; ++k) place[order[k]] = static_cast<Index>(k);

    // Touching pairs, by the row in which they will be looked for.
    std::vector<Index> row(n + 1);
    std::vector<std::pair<Index, Carried>> touching;
    for (const Block& block : blocks_) {
        const InnerPairs& inner = block.inner;
        for (std::size_t s = 0; s < inner.size; ++s) {
            const History history = inner.history(s);
            if (inner.is_padding(s) || history == History{}) continue;
            const std::size_t i = P::index(inner.first[s]), j = P::index(inner.second[s]);
            const std::int32_t image = block.outer.image[inner.outer[s]] + wraps[i] - wraps[j];
            if (place[i] < place[j])
                touching.push_back({place[i], {place[j], image, history}});
            else
                touching.push_back({place[j], {place[i], -image, -history}});
            ++row[touching.back().first + 1];
        }
    }
    std::partial_sum(row.begin(), row.end(), row.begin());
    std::vector<Carried> carried(touching.size());
    std::vector<Index> next(row.begin(), row.end() - 1);
    for (const auto& [i, pair] : touching) carried[next[i]++] = pair;

    solids_.permute(order);
    for (WallHistory& wall : at_wall_) P::permute(order, wall.values, WallHistory::record);
    Vec3 sum;
    for (std::size_t i = 0; i < n; ++i) {
        solids_.set(P::X0, i, solids_.vector(P::X, i));
        sum += solids_.vector(P::VX, i);
    }
    frame_velocity_ = (1 / static_cast<Real>(n)) * sum;
    frame_time_ = 0;
    wall_drift_ = 0;
    for (const geometry::Wall& wall : walls_)
        wall_drift_ = std::max(wall_drift_, closing_speed(wall, frame_velocity_));
    set_inner_skin(std::max(inner_skin_, least_inner_skin * mean_radius_));

    parallel_for_blocks(blocks_.size(), threads_, [&](std::size_t b) {
        Block& block = blocks_[b];
        OuterPairs &outer = block.outer, cross;
        outer.clear();
        std::vector<History> found, found_cross; // by outer pair
        for (std::size_t i = block.begin; i < block.end; ++i) {
            grid_.around(grid_.cell(i), [&](Index begin, Index end, int image) {
                const Vec3 x_i = position[order[i]] + Vec3{image * period_, 0, 0};
                const Real reach_i = *solids_.at(P::RADIUS, i) + (outer_skin_ + pair_reach_);
                for (std::size_t j = std::max<std::size_t>(begin, i + 1); j < end; ++j) {
                    const Vec3 d = x_i - position[order[j]];
                    const Real range = reach_i + *solids_.at(P::RADIUS, j);
                    if (dot(d, d) >= range * range) continue;
                    History history;
                    for (Index c = row[i]; c < row[i + 1]; ++c)
                        if (carried[c].partner == j && carried[c].image == image)
                            history = carried[c].history;
                    (j < block.end ? outer : cross).append(i, j, image);
                    (j < block.end ? found : found_cross).push_back(history);
                }
            });
        }
        outer.cross_begin = found.size();
        outer.append(cross);
        found.insert(found.end(), found_cross.begin(), found_cross.end());
        block.inner.clear(); // its numbers of outer pairs are void
        build_inner(block);
        for (std::size_t s = 0; s < block.inner.size; ++s)
            if (!block.inner.is_padding(s)) block.inner.set_history(s, found[block.inner.outer[s]]);
    });
    link_blocks();
    return true;
}

/// Filter the outer pairs of a block into its inner list; pairs that stay keep their displacements.
void Solids::build_inner(Block& block) {
    const OuterPairs& outer = block.outer;
    InnerPairs &inner = block.inner, &before = block.spare;
    std::swap(inner, before);
    inner.clear();
    std::size_t old = 0; // both lists ascend in the outer pair
    const auto take = [&](std::size_t begin, std::size_t end) {
        outer.find_near(solids_, period_, inner_skin_ + pair_reach_, begin, end, block.near);
        inner.reserve(inner.size + block.near.size() + lane_count);
        for (const Index pair : block.near) {
            while (old < before.size && before.outer[old] < pair) ++old;
            if (old < before.size && before.outer[old] == pair)
                inner.append(before, old);
            else
                inner.append(solids_, outer.first[pair], outer.second[pair],
                             outer.image[pair] * period_, pair);
        }
        inner.pad(block.begin);
    };
    take(0, outer.cross_begin);
    inner.cross_begin = inner.size;
    take(outer.cross_begin, outer.first.size());
    block.cross.resize((inner.size - inner.cross_begin) * 8);
    for (std::size_t w = 0; w < walls_.size(); ++w) find_near_wall(block, w);
}

/// Solids that have left a wall forget it before the list that knows them is made anew.
void Solids::forget_parted() {
    for (std::size_t w = 0; w < walls_.size(); ++w)
        for (const Block& block : blocks_)
            for (const Index i : block.near_wall[w])
                std::visit(
                    [&](const auto& wall) {
                        if (!wall.touches(solids_.vector(P::X, i), *solids_.at(P::RADIUS, i)))
                            at_wall_[w].clear(i);
                    },
                    walls_[w]);
}

/// List the solids of a block that may touch a wall before the next prune.
void Solids::find_near_wall(Block& block, std::size_t w) {
    std::visit(
        [&](const auto& wall) {
            const auto is_near = [&](std::size_t i) {
                return wall.touches(solids_.vector(P::X, i),
                                    *solids_.at(P::RADIUS, i) + (wall_skin_ + wall_reach_));
            };
            std::vector<Index>& near = block.near_wall[w];
            near.clear();
            for (std::size_t i = block.begin; i < block.end; ++i)
                if (is_near(i)) near.push_back(static_cast<Index>(i));
        },
        walls_[w]);
}

/// Tell every block which pairs of earlier blocks end in it.
void Solids::link_blocks() {
    if (blocks_.size() == 1) return;
    for (Block& block : blocks_) block.incoming.clear();
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
        const InnerPairs& inner = blocks_[b].inner;
        for (std::size_t s = inner.cross_begin; s < inner.size; ++s) {
            if (inner.is_padding(s)) continue;
            blocks_[P::index(inner.second[s]) / block_size].incoming.push_back(
                {static_cast<Index>(b), static_cast<Index>(s - inner.cross_begin)});
        }
    }
}

bool Solids::finite() const noexcept {
    Real check = 0;
    for (const auto field : {P::X, P::VX, P::SX})
        for (std::size_t i = 0; i < size(); ++i) {
            const Vec3 v = solids_.vector(field, i);
            check += 0 * dot(v, v); // squares: distances and energies must be finite, too
        }
    const Real most = period_ > 0 ? most_laps * period_ : std::numeric_limits<Real>::max();
    for (std::size_t i = 0; i < size(); ++i)
        if (!(std::abs(*solids_.at(P::X, i)) < most)) return false;
    return check == 0; // 0 * NaN and 0 * infinity are NaN
}

template <class T, class Value>
std::vector<T> Solids::in_callers_order(const Value& value) const {
    std::vector<T> out(size());
    for (std::size_t i = 0; i < size(); ++i) out[solids_.id()[i]] = value(i);
    return out;
}

std::vector<Vec3> Solids::position() const {
    return in_callers_order<Vec3>([&](std::size_t i) {
        Vec3 x = solids_.vector(P::X, i);
        if (period_ > 0) x.x = Lap(x.x, period_).x;
        return x;
    });
}

std::vector<std::int64_t> Solids::laps() const {
    return in_callers_order<std::int64_t>([&](std::size_t i) {
        if (period_ == 0) return std::int64_t{0};
        return solids_.laps()[i] +
               static_cast<std::int64_t>(Lap(*solids_.at(P::X, i), period_).count);
    });
}

std::vector<Vec3> Solids::velocity() const {
    return in_callers_order<Vec3>([&](std::size_t i) { return solids_.vector(P::VX, i); });
}

std::vector<Vec3> Solids::spin() const {
    return in_callers_order<Vec3>(
        [&](std::size_t i) { return (1 / *solids_.at(P::RADIUS, i)) * solids_.vector(P::SX, i); });
}

std::vector<Real> Solids::radius() const {
    return in_callers_order<Real>([&](std::size_t i) { return *solids_.at(P::RADIUS, i); });
}

std::vector<Real> Solids::mass() const {
    return in_callers_order<Real>(
        [&](std::size_t i) { return 1 / *solids_.at(P::INVERSE_MASS, i); });
}

/// The sum over kicks of m k (u - v) dt, as each implicit kick applied it, and of the part of added
/// mass.
std::vector<Vec3> Solids::drag_impulse() const {
    return in_callers_order<Vec3>([&](std::size_t i) {
        if (medium_ == Medium::responding_liquid)
            return (1 / *solids_.at(P::INVERSE_MASS, i)) * solids_.vector(P::JX, i);
        const Real rate = *solids_.at(P::DRAG, i) / *solids_.at(P::INVERSE_MASS, i);
        return rate * (forcing_time_ * solids_.vector(P::UX, i) - solids_.vector(P::PX, i));
    });
}

std::vector<Vec3> Solids::mean_velocity() const {
    require(medium_ != Medium::dry, "mean_velocity: set_forcing must be given a liquid");
    return in_callers_order<Vec3>([&](std::size_t i) {
        if (forcing_time_ == 0) return solids_.vector(P::VX, i);
        return (1 / forcing_time_) * solids_.vector(P::PX, i);
    });
}

std::vector<Vec3> Solids::liquid_velocity() const {
    require(medium_ != Medium::dry, "liquid_velocity: set_forcing must be given a liquid");
    return in_callers_order<Vec3>([&](std::size_t i) { return solids_.vector(P::UX, i); });
}

Vec3 Solids::wall_impulse() const {
    Vec3 sum;
    for (const Block& block : blocks_) sum += block.wall_impulse;
    return sum;
}

Real Solids::kinetic_energy() const {
    Real sum = 0;
    for (std::size_t i = 0; i < size(); ++i) {
        const Vec3 v = solids_.vector(P::VX, i), s = solids_.vector(P::SX, i);
        sum += (dot(v, v) + 0.4 * dot(s, s)) / (2 * *solids_.at(P::INVERSE_MASS, i));
    }
    return sum;
}

/// visit(model, contact, history, first, second) for everything that touches now.
template <class Visit>
void Solids::for_each_contact(const Visit& visit) const {
    for (const Block& block : blocks_) {
        const InnerPairs& inner = block.inner;
        for (std::size_t s = 0; s < inner.size; ++s) {
            if (inner.is_padding(s)) continue;
            const std::size_t i = P::index(inner.first[s]), j = P::index(inner.second[s]);
            const Vec3 d =
                solids_.vector(P::X, i) - solids_.vector(P::X, j) + Vec3{inner.shift[s], 0, 0};
            const Real overlap = inner.radius_sum[s] - norm(d);
            if (overlap <= 0) continue;
            const Vec3 normal = (1 / norm(d)) * d;
            const Vec3 velocity =
                solids_.vector(P::VX, i) - solids_.vector(P::VX, j) -
                cross(solids_.vector(P::SX, i) + solids_.vector(P::SX, j), normal);
            const Contact<Real> c{normal, velocity, overlap,
                                  inner.values[s * InnerPairs::record + InnerPairs::REDUCED_RADIUS],
                                  inner.values[s * InnerPairs::record + InnerPairs::REDUCED_MASS]};
            visit(pair_model_, c, inner.history(s), std::int64_t{solids_.id()[i]},
                  std::int64_t{solids_.id()[j]});
        }
    }
    for (std::size_t w = 0; w < walls_.size(); ++w) {
        std::visit(
            [&](const auto& wall) {
                for (std::size_t i = 0; i < size(); ++i) {
                    const Contact<Real> c =
                        wall_contact_of(wall, solids_.vector(P::X, i), solids_.vector(P::VX, i),
                                        solids_.vector(P::SX, i), *solids_.at(P::RADIUS, i),
                                        *solids_.at(P::INVERSE_MASS, i));
                    if (c.overlap > 0)
                        visit(wall_model_, c, at_wall_[w].at(i), std::int64_t{solids_.id()[i]},
                              -1 - static_cast<std::int64_t>(w));
                }
            },
            walls_[w]);
    }
}

Real Solids::elastic_energy() const {
    Real sum = 0;
    for_each_contact([&](const ContactModel& model, const Contact<Real>& c, const History& history,
                         std::int64_t, std::int64_t) {
        sum +=
            std::visit([&](const auto& law) { return law.energy(c, history.spring); }, model.law);
    });
    return sum;
}

ContactTable Solids::contacts() const {
    ContactTable table;
    for_each_contact([&](const ContactModel& model, const Contact<Real>& c, History history,
                         std::int64_t first, std::int64_t second) {
        const ContactForce<Real> force =
            std::visit([&](const auto& law) { return law.force(c, history.spring, 0); }, model.law);
        table.first.push_back(first);
        table.second.push_back(second);
        table.overlap.push_back(c.overlap);
        table.normal.push_back(c.normal);
        table.force.push_back(force.normal * c.normal + force.tangential);
    });
    return table;
}

namespace {

/// Writes or reads numbers in one fixed sequence, so that saving and restoring cannot disagree.
struct Writer {
    Solids::Snapshot& out;
    void same(std::int64_t v) { out.integers.push_back(v); }
    void same(Real v) { out.reals.push_back(v); }
    void operator()(Real& v) { out.reals.push_back(v); }
    template <std::integral T>
    void operator()(T& v) {
        out.integers.push_back(static_cast<std::int64_t>(v));
    }
    template <class T, class A>
    void resize(std::vector<T, A>& v) {
        out.integers.push_back(static_cast<std::int64_t>(v.size()));
    }
};

struct Reader {
    const Solids::Snapshot& in;
    std::size_t real = 0, integer = 0;
    template <class T>
    void same(T expected) {
        T v;
        (*this)(v);
        require(v == expected, "restore: the snapshot belongs to another population");
    }
    void operator()(Real& v) {
        require(real < in.reals.size(), "restore: the snapshot is too short");
        v = in.reals[real++];
    }
    template <std::integral T>
    void operator()(T& v) {
        require(integer < in.integers.size(), "restore: the snapshot is too short");
        v = static_cast<T>(in.integers[integer++]);
    }
    template <class T, class A>
    void resize(std::vector<T, A>& v) {
        std::size_t n = 0;
        (*this)(n);
        require(n <= in.reals.size() + in.integers.size(), "restore: the snapshot is damaged");
        v.resize(n);
    }
};

/// FNV-1a over the numbers: a damaged snapshot must not be read, its indices are trusted.
std::int64_t seal(std::span<const Real> reals, std::span<const std::int64_t> integers) {
    std::uint64_t hash = 14695981039346656037u;
    const auto take = [&](auto v) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(v)) * 1099511628211u;
    };
    std::ranges::for_each(reals, take);
    std::ranges::for_each(integers, take);
    return std::bit_cast<std::int64_t>(hash);
}

} // namespace

template <class Archive>
void Solids::exchange(Archive& archive) {
    const auto vec = [&](Vec3& v) {
        archive(v.x);
        archive(v.y);
        archive(v.z);
    };
    const auto vector = [&](auto& values) {
        archive.resize(values);
        for (auto& v : values) archive(v);
    };
    for (const std::size_t count : {size(), blocks_.size(), walls_.size(), lane_count})
        archive.same(static_cast<std::int64_t>(count));
    for (const Real length : {period_, pair_reach_, wall_reach_}) archive.same(length);
    solids_.for_each_array(vector);
    for (Index& id : solids_.id()) archive(id);
    for (std::int32_t& laps : solids_.laps()) archive(laps);
    for (WallHistory& wall : at_wall_) vector(wall.values);
    vec(frame_velocity_);
    for (Real* v : {&frame_time_, &approach_, &wall_approach_, &wall_drift_, &outer_skin_,
                    &inner_skin_, &wall_skin_, &fastest_})
        archive(*v);
    for (Block& block : blocks_) {
        vector(block.outer.first);
        vector(block.outer.second);
        vector(block.outer.image);
        archive(block.outer.cross_begin);
        vector(block.inner.first);
        vector(block.inner.second);
        vector(block.inner.outer);
        vector(block.inner.shift);
        vector(block.inner.radius_sum);
        vector(block.inner.values);
        vector(block.inner.touched);
        for (auto& near : block.near_wall) vector(near);
        archive(block.inner.cross_begin);
        block.inner.size = block.inner.first.size();
        block.cross.resize((block.inner.size - block.inner.cross_begin) * 8);
        vec(block.wall_force);
        vec(block.wall_impulse);
    }
}

/// The forcing of the same solids in another order, and its sums.
void Solids::take_forcing(const Solids& from) {
    std::vector<std::size_t> place(size());
    for (std::size_t i = 0; i < size(); ++i) place[from.solids_.id()[i]] = i;
    const auto take = [&](Population::Field row, std::size_t i) {
        store(solids_.at(row, i), load(from.solids_.at(row, place[solids_.id()[i]])));
    };
    for (std::size_t i = 0; i < size(); ++i) {
        for (const auto row : {P::AX, P::PX, P::UX}) take(row, i);
        if (medium_ != Medium::responding_liquid) continue;
        for (const auto row : {P::BX, P::JX}) take(row, i);
    }
}

Solids::Snapshot Solids::snapshot() const {
    Snapshot out;
    Writer writer{out};
    const_cast<Solids*>(this)->exchange(writer); // writes no member
    out.integers.push_back(seal(out.reals, out.integers));
    return out;
}

void Solids::restore(const Snapshot& snapshot) {
    const std::span integers(snapshot.integers);
    require(!integers.empty() &&
                integers.back() == seal(snapshot.reals, integers.first(integers.size() - 1)),
            "restore: the snapshot is damaged");
    Solids restored(*this); // a refused snapshot leaves all as it was
    Reader reader{snapshot};
    restored.exchange(reader);
    require(reader.real == snapshot.reals.size() && reader.integer + 1 == integers.size() &&
                restored.radius() == radius() && restored.mass() == mass(),
            "restore: the snapshot belongs to another population");
    restored.take_forcing(*this);
    *this = std::move(restored);
    link_blocks();
}

} // namespace mpsdem::dem
