#include "mps/lagrangian/liquid.hpp"

#include "core/check.hpp"
#include "core/ordered_sum.hpp"
#include "mps/divergence.hpp"
#include "mps/gradient.hpp"
#include "mps/least_squares_laplacian.hpp"
#include "mps/number_density.hpp"
#include "mps/shear_rate.hpp"
#include "mps/shifting.hpp"
#include "mps/viscosity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace mpsdem::mps::lagrangian {

namespace {

constexpr Real reach = 2.1;         // [-] r_e over the spacing, for every operator
constexpr Real longest_shift = 0.1; // [-] spacings that a particle may be shifted in a step
constexpr Real viscous_limit = 0.1; // [-] largest nu dt / dx^2
constexpr Real most_substeps = 1e4; // [-] of one call; beyond it the speeds have run away
constexpr int most_halvings = 5;    // [-] of one call

/// Put the first order.size() values in an order.
template <class T>
void reorder(std::vector<T>& values, std::span<const Index> order, int threads,
             std::vector<T>& memory) {
    memory.resize(order.size());
    parallel_for(order.size(), threads, [&](std::size_t k) { memory[k] = values[order[k]]; });
    std::ranges::copy(memory, values.begin());
}

template <class T>
std::vector<T> in_given_order(std::span<const T> values, std::span<const Index> id) {
    std::vector<T> out(id.size());
    for (std::size_t i = 0; i < values.size(); ++i) out[id[i]] = values[i];
    return out;
}

} // namespace

/// Number of liquid particles for which something holds; what decides may also change them.
template <class Holds>
std::size_t Liquid::count_liquid(const Holds& holds) const {
    return static_cast<std::size_t>(ordered_sum(liquid_count_, numerics_.threads,
                                                [&](std::size_t i) { return holds(i) ? 1. : 0.; }));
}

Liquid::Liquid(std::span<const Vec3> position, std::span<const Vec3> velocity,
               std::span<const Kind> kind, const geometry::Cylinder& wall, Real pipe_radius,
               Real pipe_length, Real density, Real kinematic_viscosity, Real roughness, Flow flow,
               const Drive& drive, const Numerics& numerics)
    : wall_(wall), pipe_radius_(pipe_radius), pipe_length_(pipe_length), density_(density),
      viscosity_(kinematic_viscosity), flow_(flow), drive_(drive), numerics_(numerics),
      reference_(numerics.particle_spacing, reach * numerics.particle_spacing),
      wall_function_(kinematic_viscosity, roughness), pairs_(reference_.weight, pipe_length),
      cells_(position, reference_.weight.effective_radius, pipe_length, numerics.threads),
      grid_(reference_.weight.effective_radius, pipe_length),
      pressure_equation_(numerics.solver, numerics.tolerance, numerics.particle_spacing,
                         numerics.threads) {
    require(position.size() == velocity.size() && position.size() == kind.size(),
            "Liquid: position, velocity and kind must have the same length");
    require(density > 0, "Liquid: density must be > 0 kg/m3");
    require(numerics.courant > 0, "Liquid: courant must be > 0");
    require(numerics.tolerance > 0, "Liquid: tolerance must be > 0");
    require(numerics.threads >= 1, "Liquid: threads must be >= 1");
    liquid_count_ = static_cast<std::size_t>(std::ranges::count(kind, Kind::liquid));
    wall_count_ = static_cast<std::size_t>(std::ranges::count(kind, Kind::wall));
    require(liquid_count_ > 0, "Liquid: at least one liquid particle is needed");
    for (const Kind k : {Kind::liquid, Kind::wall, Kind::ghost}) {
        std::vector<Vec3> at;
        std::vector<Index> id;
        for (std::size_t i = 0; i < kind.size(); ++i) {
            if (kind[i] != k) continue;
            at.push_back(position[i]);
            id.push_back(static_cast<Index>(i));
        }
        grid_.sort(at, cells_, order_, 1);
        for (const Index i : order_) {
            id_.push_back(id[i]);
            position_.push_back(at[i]);
            velocity_.push_back(velocity[id[i]]);
            kind_.push_back(k);
        }
    }
    pressure_.assign(size(), 0);
    find_pairs();
    pressure_equation_.assemble(pairs_, {});
    pressure_equation_.prepare();

    // Ghosts lie still behind the wall, and so do their shares.
    neighbors::NeighborList behind(reference_.weight.effective_radius, pipe_length);
    behind.find(std::span<const Vec3>(position_).subspan(liquid_count_), 1);
    behind_first_.push_back(0);
    for (std::size_t g = wall_count_; g < behind.rows(); ++g) {
        Real total = 0;
        behind.each(g, [&](Index w, const Vec3& r, Index) {
            if (w >= wall_count_) return;
            behind_column_.push_back(static_cast<Index>(liquid_count_) + w);
            behind_share_.push_back(reference_.weight(norm(r)));
            total += behind_share_.back();
        });
        for (std::size_t k = behind_first_.back(); k < behind_share_.size(); ++k)
            behind_share_[k] /= total;
        behind_first_.push_back(static_cast<Index>(behind_column_.size()));
    }
}

AdvanceReport Liquid::advance(Real dt) {
    require(dt > 0, "advance: dt must be > 0 s");
    AdvanceReport report;
    Real longest = dt;
    for (Real left = dt; left > 1e-9 * dt && report.sound;) {
        const Real count = std::ceil(left / std::min(stable_step(), longest) - 1e-9);
        if (!(count < most_substeps)) {
            report.sound = false;
            break;
        }
        const Real length = left / std::max(count, 1.);
        if (!step(length, report)) {
            longest = length / 2;
            report.sound = ++report.halvings <= most_halvings;
            continue;
        }
        left -= length;
        ++report.substeps;
        report.mean_gradient += gradient_ * length / dt;
        report.friction += friction_ * length / dt;
        report.unexplained += unexplained_ * length / dt;
    }
    return report;
}

Real Liquid::dynamic_pressure() const noexcept {
    return density_ * drive_.bulk_velocity * drive_.bulk_velocity;
}

Real Liquid::fastest() const {
    Real square = 0;
    for (const Vec3& u : liquid_velocity()) square = std::max(square, dot(u, u));
    return std::sqrt(square);
}

/// Largest step for the speeds and the molecular viscosity [s]; the eddy viscosity is cut to fit.
Real Liquid::stable_step() const {
    const Real dx = numerics_.particle_spacing;
    const Real speed = std::max(fastest(), std::numeric_limits<Real>::min());
    return std::min(numerics_.courant * dx / speed, viscous_limit * dx * dx / viscosity_);
}

/// One substep; `false` and the state as before where the pressure could not be solved.
bool Liquid::step(Real dt, AdvanceReport& report) {
    sort();
    find_pairs();
    velocity_before_ = velocity_;
    const Real before = bulk_velocity();
    predict(dt, report);
    friction_ = density_ * (before - bulk_velocity()) / dt;
    if (!solve_pressure(dt, report)) {
        velocity_ = velocity_before_;
        return false;
    }
    correct(dt);
    move(dt, report);
    return true;
}

/// Put neighbors in space near in memory.
void Liquid::sort() {
    const int threads = numerics_.threads;
    grid_.sort(liquid_position(), cells_, order_, threads);
    reorder(position_, order_, threads, shift_);
    reorder(velocity_, order_, threads, shift_);
    reorder(pressure_, order_, threads, scalar_);
    reorder(id_, order_, threads, id_memory_);
}

void Liquid::find_pairs() {
    const std::size_t ghosts = size() - liquid_count_ - wall_count_;
    pairs_.find(position_, {{liquid_count_, wall_count_, ghosts}, liquid_count_ + wall_count_},
                numerics_.threads);
}

/// Viscosity and wall shear, on the liquid.
void Liquid::predict(Real dt, AdvanceReport& report) {
    const int threads = numerics_.threads;
    acceleration_.resize(liquid_count_);
    if (turbulent()) {
        find_eddy_viscosity(dt, report);
        viscous_acceleration(reference_, pairs_, eddy_viscosity_, velocity_, threads,
                             acceleration_);
        add_wall_shear();
    } else {
        deficient_.resize(liquid_count_);
        least_squares_laplacian<geometry::Cylinder, Vec3>(
            wall_, pairs_.neighbors(), kind_, velocity_, threads, acceleration_, deficient_);
        report.deficient += static_cast<std::size_t>(std::ranges::count(deficient_, 1));
        for (Vec3& a : acceleration_) a = viscosity_ * a;
    }
    parallel_for(liquid_count_, threads,
                 [&](std::size_t i) { velocity_[i] += dt * acceleration_[i]; });
}

void Liquid::find_eddy_viscosity(Real dt, AdvanceReport& report) {
    const int threads = numerics_.threads;
    const Real dx = numerics_.particle_spacing;
    const Real largest = viscous_limit * dx * dx / dt;
    scalar_.resize(liquid_count_);
    eddy_viscosity_.resize(liquid_count_);
    shear_rate(pairs_, velocity_, threads, scalar_);
    std::visit(
        [&]<class Model>(const Model& model) {
            if constexpr (LengthModel<Model>)
                eddy_viscosity(model, liquid_position(), scalar_, largest, threads,
                               eddy_viscosity_);
        },
        flow_);
    report.viscosity_capped +=
        count_liquid([&](std::size_t i) { return eddy_viscosity_[i] == largest; });
    parallel_for(liquid_count_, threads, [&](std::size_t i) { eddy_viscosity_[i] += viscosity_; });
}

/// Shear of the log law on the liquid nearer to the wall than a spacing. The layer's particles
/// carry the shear of the whole wall, however many they are at the moment.
void Liquid::add_wall_shear() {
    const Real dx = numerics_.particle_spacing;
    const int threads = numerics_.threads;
    constexpr Real outside_the_layer = -1;
    parallel_for(liquid_count_, threads, [&](std::size_t i) {
        const Real distance = wall_.at(position_[i]).distance;
        scalar_[i] = outside_the_layer;
        if (distance >= dx) return;
        const Real speed = norm(velocity_[i]);
        const Real y = std::max(distance, nearest_liquid * dx);
        scalar_[i] = speed == 0 ? 0 : wall_function_.shear(speed, y) / speed; // [1/s m]
    });
    std::size_t layer = 0;
    Real sum = 0; // of shear over density
    for (std::size_t i = 0; i < liquid_count_; ++i) {
        if (scalar_[i] == outside_the_layer) continue;
        ++layer;
        sum += scalar_[i] * velocity_[i].x;
    }
    if (layer == 0) return;
    const auto count = static_cast<Real>(layer);
    // wall area over the layer's volume: 2 pi R L / (count pi R^2 L / liquid)
    const Real per_volume = 2 * static_cast<Real>(liquid_count_) / (pipe_radius_ * count);
    parallel_for(liquid_count_, threads, [&](std::size_t i) {
        if (scalar_[i] != outside_the_layer)
            acceleration_[i] -= (per_volume * scalar_[i]) * velocity_[i];
    });
    wall_shear_ = density_ * sum / count;
}

/// Source, solve, cuts, ghosts; `false` where the equation could not be solved.
bool Liquid::solve_pressure(Real dt, AdvanceReport& report) {
    const int threads = numerics_.threads;
    const std::size_t unknowns = pairs_.rows();
    right_hand_side_.resize(unknowns);
    const auto source = std::span(right_hand_side_).first(liquid_count_);
    if (turbulent())
        slip_divergence(wall_, reference_, pairs_, velocity_, threads, source);
    else
        corrected_divergence(wall_, reference_, pairs_, velocity_, threads, source);
    const Real scale =
        -density_ / dt * reference_.number_density * reference_.lambda / (2 * dimensions);
    parallel_for(unknowns, threads, [&](std::size_t i) {
        right_hand_side_[i] = i < liquid_count_ ? scale * right_hand_side_[i] : 0;
    });
    remove_axial_bias();
    pressure_before_.assign(pressure_.begin(),
                            pressure_.begin() + static_cast<std::ptrdiff_t>(unknowns));
    pressure_equation_.assemble(pairs_, {});
    if (!pressure_equation_.solve(right_hand_side_, std::span(pressure_).first(unknowns),
                                  report.solve)) {
        std::ranges::copy(pressure_before_, pressure_.begin());
        return false;
    }
    cut_pressure(report);
    extrapolate_pressure();
    return true;
}

/// The disorder of the particles leaves in the source a random axial wave, which the solve would
/// amplify with the length of the pipe. In a full rigid pipe the flux through every section is the
/// same: the source's mean over each diameter of length is zero, and is made so.
void Liquid::remove_axial_bias() {
    const auto bins = std::max<std::size_t>(
        1, static_cast<std::size_t>(std::lround(pipe_length_ / (2 * pipe_radius_))));
    const Real width = pipe_length_ / static_cast<Real>(bins);
    std::vector<Real> sum(bins), count(bins);
    for (std::size_t i = 0; i < liquid_count_; ++i) {
        const auto b = std::min(static_cast<std::size_t>(pairs_.position(i).x / width), bins - 1);
        sum[b] += right_hand_side_[i];
        count[b] += 1;
    }
    for (std::size_t b = 0; b < bins; ++b) sum[b] /= std::max(count[b], 1.);
    parallel_for(liquid_count_, numerics_.threads, [&](std::size_t i) {
        const Real place = pairs_.position(i).x / width - 0.5;
        const Real below = std::floor(place);
        const auto b = static_cast<std::size_t>(below + static_cast<Real>(bins)) % bins;
        const Real share = place - below;
        right_hand_side_[i] -= (1 - share) * sum[b] + share * sum[(b + 1) % bins];
    });
}

/// Give p' mean zero in the liquid, and cut it to the limit.
void Liquid::cut_pressure(AdvanceReport& report) {
    const int threads = numerics_.threads;
    const auto count = static_cast<Real>(liquid_count_);
    const Real mean =
        ordered_sum(liquid_count_, threads, [&](std::size_t i) { return pressure_[i]; }) / count;
    const Real limit = turbulent() && dynamic_pressure() > 0
                           ? numerics_.pressure_limit * dynamic_pressure()
                           : std::numeric_limits<Real>::infinity();
    report.clamped +=
        count_liquid([&](std::size_t i) { return std::abs(pressure_[i] - mean) > limit; });
    parallel_for(pairs_.rows(), threads, [&](std::size_t i) {
        pressure_[i] = std::clamp(pressure_[i] - mean, -limit, limit);
    });
    pressure_noise_ = std::sqrt(ordered_sum(liquid_count_, threads,
                                            [&](std::size_t i) {
                                                const Real change =
                                                    pressure_[i] - pressure_before_[i];
                                                return change * change;
                                            }) /
                                count);
}

/// A ghost has the pressure of the wall before it.
void Liquid::extrapolate_pressure() {
    const std::size_t first_ghost = liquid_count_ + wall_count_;
    parallel_for(size() - first_ghost, numerics_.threads, [&](std::size_t g) {
        Real sum = 0;
        for (Index k = behind_first_[g]; k < behind_first_[g + 1]; ++k)
            sum += behind_share_[k] * pressure_[behind_column_[k]];
        pressure_[first_ghost + g] = sum;
    });
}

/// Gradient of p', then the mean axial gradient: given, or what holds the bulk velocity.
void Liquid::correct(Real dt) {
    const int threads = numerics_.threads;
    background_gradient(numerics_.pairing, numerics_.background * dynamic_pressure(), wall_,
                        reference_, pairs_, pressure_, threads, acceleration_);
    const Real before = bulk_velocity();
    parallel_for(liquid_count_, threads,
                 [&](std::size_t i) { velocity_[i] -= (dt / density_) * acceleration_[i]; });
    const Real bulk = bulk_velocity();
    unexplained_ = density_ * (bulk - before) / dt;
    gradient_ = drive_.pressure_gradient ? *drive_.pressure_gradient
                                         : density_ * (drive_.bulk_velocity - bulk) / dt;
    const Real kick = dt * gradient_ / density_;
    parallel_for(liquid_count_, threads, [&](std::size_t i) { velocity_[i].x += kick; });
}

/// Move with the velocity, and shift towards where particles are few. The shift goes with the way
/// that the liquid makes: disorder comes from it, and a shift of every step, however short, would
/// mix the momentum of a flow whose steps viscosity limits.
void Liquid::move(Real dt, AdvanceReport& report) {
    const Real dx = numerics_.particle_spacing;
    const Real longest = longest_shift * dx;
    const Real way = fastest() * dt / dx;
    shift_.resize(liquid_count_);
    shifting(numerics_.shift * way, reference_, pairs_, numerics_.threads, shift_);
    report.shifts_cut += count_liquid([&](std::size_t i) {
        const Real length = norm(shift_[i]);
        if (length > longest) shift_[i] = (longest / length) * shift_[i];
        return length > longest;
    });
    const Real farthest = pipe_radius_ - nearest_liquid * dx;
    report.held_back += count_liquid([&](std::size_t i) {
        Vec3 x = pairs_.position(i) + dt * velocity_[i] + shift_[i];
        const Real r2 = x.y * x.y + x.z * x.z;
        const bool beyond = r2 > farthest * farthest;
        if (beyond) {
            const Real inwards = farthest / std::sqrt(r2);
            x.y *= inwards;
            x.z *= inwards;
        }
        x.x -= std::floor(x.x / pipe_length_) * pipe_length_;
        position_[i] = x.x < pipe_length_ ? x : Vec3{0, x.y, x.z};
        return beyond;
    });
    const std::size_t lost = count_liquid([&](std::size_t i) {
        return !std::isfinite(dot(velocity_[i], velocity_[i]) + dot(position_[i], position_[i]));
    });
    report.sound = report.sound && lost == 0;
}

std::vector<Vec3> Liquid::position() const {
    return in_given_order<Vec3>(position_, id_);
}
std::vector<Vec3> Liquid::velocity() const {
    return in_given_order<Vec3>(velocity_, id_);
}
std::vector<Kind> Liquid::kind() const {
    return in_given_order<Kind>(kind_, id_);
}
std::vector<Real> Liquid::pressure() const {
    return in_given_order<Real>(pressure_, id_);
}

Real Liquid::bulk_velocity() const {
    return ordered_sum(liquid_count_, numerics_.threads,
                       [&](std::size_t i) { return velocity_[i].x; }) /
           static_cast<Real>(liquid_count_);
}

Real Liquid::kinetic_energy() const {
    return ordered_sum(liquid_count_, numerics_.threads,
                       [&](std::size_t i) { return dot(velocity_[i], velocity_[i]) / 2; }) /
           static_cast<Real>(liquid_count_);
}

std::vector<Real> Liquid::density_ratio() const {
    std::vector<Real> ratio(pairs_.rows());
    number_density(pairs_, numerics_.threads, ratio);
    const auto last = ratio.begin() + static_cast<std::ptrdiff_t>(liquid_count_);
    const Real mean =
        std::accumulate(ratio.begin(), last, Real{0}) / static_cast<Real>(liquid_count_);
    for (Real& r : ratio) r /= mean;
    return in_given_order<Real>(ratio, id_);
}

Real Liquid::density_scatter() const {
    const std::vector<Real> ratio = density_ratio();
    Real sum = 0;
    for (std::size_t i = 0; i < liquid_count_; ++i)
        sum += (ratio[id_[i]] - 1) * (ratio[id_[i]] - 1);
    return std::sqrt(sum / static_cast<Real>(liquid_count_));
}

void Liquid::restore(const Snapshot& s) {
    require(s.position.size() == size() && s.velocity.size() == size() &&
                s.pressure.size() == size() && s.id.size() == size(),
            "restore: the snapshot belongs to another liquid");
    position_ = s.position;
    velocity_ = s.velocity;
    pressure_ = s.pressure;
    id_ = s.id;
    find_pairs();
}

} // namespace mpsdem::mps::lagrangian
