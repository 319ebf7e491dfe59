#include "mps/lagrangian/liquid.hpp"

#include "core/check.hpp"
#include "mps/divergence.hpp"
#include "mps/gradient.hpp"
#include "mps/least_squares_laplacian.hpp"
#include "mps/number_density.hpp"
#include "mps/shear_rate.hpp"
#include "mps/viscosity.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace mpsdem::mps::lagrangian {

namespace {

constexpr Real reach = 2.1;          // [-] r_e over the spacing, for every operator
constexpr Real longest_shift = 0.1;  // [-] spacings that a particle may be shifted in a step
constexpr Real viscous_limit = 0.1;  // [-] largest nu dt / dx^2
constexpr Real most_substeps = 1e4;  // [-] of one call; beyond it the speeds have run away
constexpr int most_halvings = 5;     // [-] of one call
constexpr int most_iterations = 500; // [-] of the pressure equation
constexpr Real spare_places = 0.05;  // [-] of the liquid, for what a plate brings in
// [-] of a section's difference from the plate's velocity, made good in a step: the disorder of the
// particles that come and go is not followed, and a lasting difference does not build up
constexpr Real flux_feedback = 0.3;
constexpr Real outlet_hold = 100; // [-] Dirichlet part over n0: p' is held to zero within a percent
constexpr Index none = std::numeric_limits<Index>::max();

template <class T>
void reorder(std::vector<T>& values, const std::vector<Index>& order) {
    std::vector<T> sorted(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = values[order[k]];
    values = std::move(sorted);
}

void require_drive(const Ends& ends, const Drive& drive) {
    require(ends.periodic() ||
                (!drive.pressure_gradient && drive.bulk_velocity == ends.plate_velocity()),
            "Liquid: a plate drives the liquid: bulk_velocity must be the plate's, and no "
            "pressure_gradient be given");
}

Ends ends_of(Real pipe_length, const std::optional<PushPlate>& plate, std::span<const Kind> kind) {
    if (!plate) return Ends(pipe_length);
    const Real length = plate->stroke + plate->settling + pipe_length + plate->outlet;
    return {pipe_length, *plate,
            static_cast<Real>(std::ranges::count(kind, Kind::liquid)) / length};
}

} // namespace

Liquid::Liquid(std::span<const Vec3> position, std::span<const Vec3> velocity,
               std::span<const Kind> kind, Real pipe_radius, Real pipe_length,
               const std::optional<PushPlate>& plate, Real density, Real kinematic_viscosity,
               Real roughness, Flow flow, const Drive& drive, const Numerics& numerics)
    : ends_(ends_of(pipe_length, plate, kind)),
      wall_(pipe_radius, plate ? ends_.face() : Bore::no_plate()), pipe_radius_(pipe_radius),
      pipe_length_(pipe_length), density_(density), viscosity_(kinematic_viscosity), flow_(flow),
      drive_(drive), numerics_(numerics),
      reference_(numerics.particle_spacing, reach * numerics.particle_spacing),
      wall_function_(kinematic_viscosity, roughness), mixing_length_(pipe_radius),
      neighbors_(reach * numerics.particle_spacing, ends_.period()),
      position_(position.begin(), position.end()), velocity_(velocity.begin(), velocity.end()),
      kind_(kind.begin(), kind.end()) {
    require(position.size() == velocity.size() && position.size() == kind.size(),
            "Liquid: position, velocity and kind must have the same length");
    require_drive(ends_, drive);
    require(density > 0, "Liquid: density must be > 0 kg/m3");
    require(numerics.courant > 0, "Liquid: courant must be > 0");
    require(numerics.tolerance > 0, "Liquid: tolerance must be > 0");
    require(numerics.threads >= 1, "Liquid: threads must be >= 1");
    liquid_count_ = static_cast<std::size_t>(std::ranges::count(kind_, Kind::liquid));
    require(liquid_count_ > 0, "Liquid: at least one liquid particle is needed");
    places_ = size();
    if (plate)
        places_ += static_cast<std::size_t>(spare_places * static_cast<Real>(liquid_count_)) + 1;
    for (std::size_t i = 0; i < size(); ++i) {
        if (!ends_.periodic() && kind_[i] != Kind::liquid && wall_.of_plate(position_[i]))
            velocity_[i] = {ends_.plate_velocity(), 0, 0};
    }
    pressure_.assign(size(), 0);
    id_.resize(size());
    std::iota(id_.begin(), id_.end(), Index{0});
}

void Liquid::drive(const Drive& drive) {
    require_drive(ends_, drive);
    drive_ = drive;
}

AdvanceReport Liquid::advance(Real dt) {
    require(dt > 0, "advance: dt must be > 0 s");
    AdvanceReport report;
    // The coarse matrix lives within a call, so that the state between calls is all there is.
    preconditioner_.reset();
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

/// Largest step for the speeds and the molecular viscosity [s]; the eddy viscosity is cut to fit.
Real Liquid::stable_step() const {
    Real fastest2 = 0;
    for (const Vec3& u : velocity_) fastest2 = std::max(fastest2, dot(u, u));
    const Real dx = numerics_.particle_spacing;
    const Real speed = std::max(std::sqrt(fastest2), std::numeric_limits<Real>::min());
    return std::min(numerics_.courant * dx / speed, viscous_limit * dx * dx / viscosity_);
}

/// One substep; `false` and the state as before where the pressure could not be solved.
bool Liquid::step(Real dt, AdvanceReport& report) {
    sort();
    neighbors_.find(position_, numerics_.threads);
    const std::vector<Vec3> velocity_before = velocity_;
    const Real before = bulk_velocity();
    const AxialBins bins_before = axial_velocity();
    predict(dt, report);
    friction_ = density_ * (before - bulk_velocity()) / dt;
    assemble(dt);
    if (!solve_pressure(report)) {
        velocity_ = velocity_before;
        return false;
    }
    take_pressure(report);
    correct(dt, bins_before);
    move(dt, report);
    if (!ends_.periodic()) move_plate(dt, report);
    return true;
}

/// Put neighbors in space near in memory.
void Liquid::sort() {
    const auto order = neighbors::cell_order(position_, neighbors_.radius(), ends_.period());
    reorder(position_, order);
    reorder(velocity_, order);
    reorder(kind_, order);
    reorder(pressure_, order);
    reorder(id_, order);
}

/// Viscosity and wall shear, on the liquid.
void Liquid::predict(Real dt, AdvanceReport& report) {
    const std::size_t n = size();
    const int threads = numerics_.threads;
    const Real dx = numerics_.particle_spacing;
    acceleration_.resize(n);
    if (flow_ == Flow::laminar) {
        deficient_.resize(n);
        least_squares_laplacian<geometry::Cylinder, Vec3>(wall_, neighbors_, kind_, velocity_,
                                                          threads, acceleration_, deficient_);
        report.deficient += static_cast<std::size_t>(std::ranges::count(deficient_, 1));
        for (Vec3& a : acceleration_) a = viscosity_ * a;
        if (!ends_.periodic()) smooth_beside_plate();
    } else {
        scalar_.resize(n);
        eddy_viscosity_.resize(n);
        shear_rate(reference_.weight, neighbors_, kind_, velocity_, threads, scalar_);
        const Real largest = viscous_limit * dx * dx / dt;
        eddy_viscosity(mixing_length_, position_, scalar_, largest, threads, eddy_viscosity_);
        report.viscosity_capped +=
            static_cast<std::size_t>(std::ranges::count(eddy_viscosity_, largest));
        for (Real& nu : eddy_viscosity_) nu += viscosity_;
        viscous_acceleration(reference_, neighbors_, kind_, eddy_viscosity_, velocity_, threads,
                             acceleration_);
        add_wall_shear();
    }
    parallel_for(n, threads, [&](std::size_t i) {
        if (moves(i)) velocity_[i] += dt * acceleration_[i];
    });
}

/// Within a radius of the plate, where liquid is pressed together and turned round, polynomials
/// through the neighbors lose their hold: there only the pairwise sum, which can but smooth.
void Liquid::smooth_beside_plate() {
    eddy_viscosity_.assign(size(), viscosity_);
    shift_.resize(size());
    viscous_acceleration(reference_, neighbors_, kind_, eddy_viscosity_, velocity_,
                         numerics_.threads, shift_);
    const Real end = ends_.face() + pipe_radius_;
    for (std::size_t i = 0; i < size(); ++i)
        if (position_[i].x < end) acceleration_[i] = shift_[i];
}

/// Shear of the log law on the liquid nearer to the wall than a spacing. The layer's particles
/// carry the shear of the whole wall, however many they are at the moment.
void Liquid::add_wall_shear() {
    const Real dx = numerics_.particle_spacing;
    std::size_t layer = 0, liquid = 0;
    Real sum = 0; // of shear over density
    scalar_.assign(size(), 0);
    for (std::size_t i = 0; i < size(); ++i) {
        if (!moves(i)) continue;
        ++liquid;
        const Real distance = wall_.at(position_[i]).distance;
        if (distance >= dx) continue;
        const Real speed = norm(velocity_[i]);
        ++layer;
        if (speed == 0) continue;
        const Real shear = wall_function_.shear(speed, std::max(distance, nearest_liquid * dx));
        scalar_[i] = shear / speed;
        sum += shear * velocity_[i].x / speed;
    }
    if (layer == 0) return;
    const auto count = static_cast<Real>(layer);
    // wall area over the layer's volume: 2 pi R L / (count pi R^2 L / liquid)
    const Real per_volume = 2 * static_cast<Real>(liquid) / (pipe_radius_ * count);
    parallel_for(size(), numerics_.threads, [&](std::size_t i) {
        acceleration_[i] -= (per_volume * scalar_[i]) * velocity_[i];
    });
    wall_shear_ = density_ * sum / count;
}

/// Solve for p'; where the solve fails, once more from zero with a new coarse matrix.
bool Liquid::solve_pressure(AdvanceReport& report) {
    const auto start = std::chrono::steady_clock::now();
    const int threads = numerics_.threads;
    const linear::LaplacianMatrix matrix(row_, column_, weight_, dirichlet_, threads);
    const linear::Clusters clusters(matrix);
    bool solved = false;
    for (int attempt = 0; attempt < 2 && !solved; ++attempt) {
        if (attempt > 0) {
            std::ranges::fill(solution_, Real{0});
            preconditioner_.reset();
            ++report.retries;
        }
        if (preconditioner_) {
            preconditioner_->follow(matrix, unknown_position_);
        } else {
            preconditioner_.emplace(
                matrix,
                linear::Cloud{unknown_position_, numerics_.particle_spacing, ends_.period()},
                threads);
        }
        const auto solve =
            linear::conjugate_gradients(matrix, clusters, *preconditioner_, right_hand_side_,
                                        numerics_.tolerance, most_iterations, threads, solution_);
        report.iterations += solve.iterations;
        report.residual = std::max(report.residual, solve.residual);
        solved = solve.outcome == linear::Outcome::converged;
    }
    report.solve_seconds +=
        std::chrono::duration<Real>(std::chrono::steady_clock::now() - start).count();
    return solved;
}

/// Take over p' cut to the limit, with mean zero in the liquid where nothing holds it; a ghost gets
/// the wall's.
void Liquid::take_pressure(AdvanceReport& report) {
    Real mean = 0, change = 0;
    for (std::size_t k = 0; k < particle_.size(); ++k)
        if (kind_[particle_[k]] == Kind::liquid) mean += solution_[k];
    mean /= static_cast<Real>(liquid_count_);
    const Real scale = density_ * drive_.bulk_velocity * drive_.bulk_velocity;
    const Real limit = flow_ == Flow::turbulent && scale > 0
                           ? numerics_.pressure_limit * scale
                           : std::numeric_limits<Real>::infinity();
    for (std::size_t k = 0; k < particle_.size(); ++k) {
        const std::size_t i = particle_[k];
        const Real about = std::clamp(solution_[k] - mean, -limit, limit);
        const Real p = ends_.periodic() ? about : mean + about;
        if (kind_[i] == Kind::liquid) {
            if (about != solution_[k] - mean) ++report.clamped;
            change += (p - pressure_[i]) * (p - pressure_[i]);
        }
        pressure_[i] = p;
    }
    pressure_noise_ = std::sqrt(change / static_cast<Real>(liquid_count_));
    parallel_for(size(), numerics_.threads, [&](std::size_t i) {
        if (kind_[i] != Kind::ghost) return;
        Real sum = 0, weights = 0;
        neighbors_.each(i, [&](Index j, const Vec3& r) {
            if (kind_[j] != Kind::wall) return;
            const Real w = reference_.weight(norm(r));
            sum += w * pressure_[j];
            weights += w;
        });
        pressure_[i] = weights > 0 ? sum / weights : 0;
    });
}

/// Matrix and right-hand side over liquid and wall particles.
void Liquid::assemble(Real dt) {
    const std::size_t n = size();
    const int threads = numerics_.threads;
    unknown_.resize(n);
    particle_.clear();
    for (std::size_t i = 0; i < n; ++i) {
        unknown_[i] = kind_[i] == Kind::ghost ? none : static_cast<Index>(particle_.size());
        if (kind_[i] != Kind::ghost) particle_.push_back(static_cast<Index>(i));
    }
    const std::size_t unknowns = particle_.size();
    row_.assign(unknowns + 1, 0);
    parallel_for(unknowns, threads, [&](std::size_t k) {
        Index count = 0;
        neighbors_.each(particle_[k], [&](Index j, const Vec3&) { count += unknown_[j] != none; });
        row_[k + 1] = count;
    });
    std::partial_sum(row_.begin(), row_.end(), row_.begin());
    column_.resize(row_.back());
    weight_.resize(row_.back());
    scalar_.resize(n);
    slip_divergence(wall_, reference_, neighbors_, kind_, velocity_, threads, scalar_);
    const Real scale =
        -density_ / dt * reference_.number_density * reference_.lambda / (2 * dimensions);
    right_hand_side_.resize(unknowns);
    solution_.resize(unknowns);
    unknown_position_.resize(unknowns);
    parallel_for(unknowns, threads, [&](std::size_t k) {
        const std::size_t i = particle_[k];
        Index at = row_[k];
        neighbors_.each(i, [&](Index j, const Vec3& r) {
            if (unknown_[j] == none) return;
            column_[at] = unknown_[j];
            weight_[at++] = static_cast<float>(reference_.weight(norm(r)));
        });
        right_hand_side_[k] = moves(i) ? scale * scalar_[i] : 0;
        solution_[k] = pressure_[i];
        unknown_position_[k] = neighbors_.position(i);
    });
    dirichlet_.clear();
    if (!ends_.periodic()) {
        dirichlet_.assign(unknowns, 0);
        for (std::size_t k = 0; k < unknowns; ++k)
            if (!ends_.inside(position_[particle_[k]]))
                dirichlet_[k] = outlet_hold * reference_.number_density;
    }
    remove_axial_bias();
}

/// The disorder of the particles leaves in the source a random axial wave, which the solve would
/// amplify with the length of the pipe. In a full rigid pipe the flux through every section is the
/// same, and a plate's too: the source's mean over each diameter of length is zero, and is made so.
void Liquid::remove_axial_bias() {
    AxialBins bias = ends_.bins(2 * pipe_radius_);
    for (std::size_t k = 0; k < particle_.size(); ++k)
        if (moves(particle_[k])) bias.add(unknown_position_[k].x, right_hand_side_[k]);
    bias.take_means();
    parallel_for(particle_.size(), numerics_.threads, [&](std::size_t k) {
        if (moves(particle_[k])) right_hand_side_[k] -= bias.at(unknown_position_[k].x);
    });
}

/// Gradient of p', then what drives the liquid along the pipe.
void Liquid::correct(Real dt, const AxialBins& before) {
    const Real scale = density_ * drive_.bulk_velocity * drive_.bulk_velocity;
    background_gradient(numerics_.background * scale, wall_, reference_, neighbors_, kind_,
                        pressure_, numerics_.threads, acceleration_);
    const Real bulk = bulk_velocity();
    for (std::size_t i = 0; i < size(); ++i)
        if (moves(i)) velocity_[i] -= (dt / density_) * acceleration_[i];
    unexplained_ = density_ * (bulk_velocity() - bulk) / dt;
    if (ends_.periodic())
        hold_bulk_velocity(dt);
    else
        hold_flux_of_plate(dt, before);
}

/// The mean axial gradient: given, or what holds the bulk velocity.
void Liquid::hold_bulk_velocity(Real dt) {
    gradient_ = drive_.pressure_gradient ? *drive_.pressure_gradient
                                         : density_ * (drive_.bulk_velocity - bulk_velocity()) / dt;
    const Real kick = dt * gradient_ / density_;
    for (std::size_t i = 0; i < size(); ++i)
        if (kind_[i] == Kind::liquid) velocity_[i].x += kick;
}

/// The axial gradient that gives each section back what it lost in this step, and brings it nearer
/// to the plate's velocity. The loss of pressure along the bore is its mean and what p' falls.
void Liquid::hold_flux_of_plate(Real dt, const AxialBins& before) {
    const AxialBins after = axial_velocity();
    const Real aim = ends_.plate_velocity();
    parallel_for(size(), numerics_.threads, [&](std::size_t i) {
        scalar_[i] = 0;
        if (!moves(i)) return;
        const Real was = before.at(position_[i].x);
        scalar_[i] = was - after.at(position_[i].x) + flux_feedback * (aim - was);
        velocity_[i].x += scalar_[i];
    });
    const Real kick = mean_in_bore([&](std::size_t i) { return scalar_[i]; });
    const Real middle = mean_in_bore([&](std::size_t i) { return position_[i].x; });
    const Real level = mean_in_bore([&](std::size_t i) { return pressure_[i]; });
    const Real together = mean_in_bore(
        [&](std::size_t i) { return (position_[i].x - middle) * (pressure_[i] - level); });
    const Real spread = mean_in_bore(
        [&](std::size_t i) { return (position_[i].x - middle) * (position_[i].x - middle); });
    gradient_ = density_ * kick / dt - together / spread;
}

/// Mean axial velocity of each diameter of length.
AxialBins Liquid::axial_velocity() const {
    AxialBins bins = ends_.bins(2 * pipe_radius_);
    if (ends_.periodic()) return bins;
    for (std::size_t i = 0; i < size(); ++i)
        if (moves(i)) bins.add(position_[i].x, velocity_[i].x);
    bins.take_means();
    return bins;
}

void Liquid::move(Real dt, AdvanceReport& report) {
    const Real dx = numerics_.particle_spacing;
    const Real scale = -numerics_.shift * dx * dx * dimensions / reference_.number_density;
    const Real longest = longest_shift * dx;
    shift_.resize(size());
    density_number_.resize(size());
    number_density(reference_.weight, neighbors_, numerics_.threads, density_number_);
    parallel_for(size(), numerics_.threads, [&](std::size_t i) {
        Vec3 sum;
        if (moves(i)) {
            neighbors_.each(i, [&](Index, const Vec3& r) {
                sum += reference_.weight.over_square(dot(r, r)) * r;
            });
        }
        shift_[i] = scale * sum;
    });
    const Real farthest = pipe_radius_ - nearest_liquid * dx;
    for (std::size_t i = 0; i < size(); ++i) {
        if (kind_[i] != Kind::liquid) continue;
        const Real length = norm(shift_[i]);
        if (length > longest) ++report.shifts_cut;
        const Vec3 shift = (length > longest ? longest / length : 1) * shift_[i];
        Vec3 x = neighbors_.position(i) + dt * velocity_[i] + shift;
        const Real r = std::hypot(x.y, x.z);
        if (r > farthest) {
            x.y *= farthest / r;
            x.z *= farthest / r;
            ++report.held_back;
        }
        if (ends_.periodic()) {
            x.x -= std::floor(x.x / pipe_length_) * pipe_length_;
            if (x.x >= pipe_length_) x.x = 0; // rounded up from just below zero
        }
        position_[i] = x;
        report.sound = report.sound && std::isfinite(dot(velocity_[i], velocity_[i])) &&
                       std::isfinite(dot(x, x));
    }
}

/// The plate goes on, ahead of the liquid next to it, and at the end of its stroke jumps back; what
/// has passed the outlet is dropped.
void Liquid::move_plate(Real dt, AdvanceReport& report) {
    const auto carry = [&](Real distance) {
        for (std::size_t i = 0; i < size(); ++i) {
            if (kind_[i] != Kind::liquid && wall_.of_plate(position_[i]))
                position_[i].x += distance;
        }
    };
    const Real from = ends_.face();
    ends_.advance(dt);
    carry(ends_.face() - from);
    const Real nearest = ends_.face() + nearest_liquid * numerics_.particle_spacing;
    std::vector<std::uint8_t> kept(size(), 1);
    for (std::size_t i = 0; i < size(); ++i) {
        if (kind_[i] != Kind::liquid) continue;
        if (position_[i].x < nearest) {
            position_[i].x = nearest;
            velocity_[i].x = std::max(velocity_[i].x, ends_.plate_velocity());
            ++report.pushed;
        }
        if (ends_.beyond(position_[i])) {
            kept[i] = 0;
            ++report.left;
        }
    }
    keep(kept);
    if (ends_.stroke_done()) {
        const Real seam = ends_.seam(), face = ends_.face();
        kept.assign(size(), 1);
        for (std::size_t i = 0; i < size(); ++i) {
            if (kind_[i] == Kind::liquid && position_[i].x < seam) {
                kept[i] = 0;
                ++report.replaced;
            }
        }
        keep(kept);
        const Refill refill = ends_.jump_back(position_, velocity_, pressure_, kind_,
                                              places_ - size(), numerics_.particle_spacing);
        carry(ends_.face() - face);
        enter(refill.entrants);
        ++report.plate_returns;
        report.entered += refill.entrants.size();
        report.crowded += refill.crowded;
    }
    wall_.place_plate(ends_.face());
}

/// Drop the particles that are not to be kept.
void Liquid::keep(const std::vector<std::uint8_t>& kept) {
    std::vector<Index> order;
    order.reserve(size());
    for (std::size_t i = 0; i < size(); ++i)
        if (kept[i] != 0) order.push_back(static_cast<Index>(i));
    if (order.size() == size()) return;
    liquid_count_ -= size() - order.size();
    reorder(position_, order);
    reorder(velocity_, order);
    reorder(kind_, order);
    reorder(pressure_, order);
    reorder(density_number_, order);
    reorder(id_, order);
}

/// New liquid, in the first places that are free.
void Liquid::enter(std::span<const Entrant> entrants) {
    std::vector<std::uint8_t> taken(places_, 0);
    for (const Index id : id_) taken[id] = 1;
    Index place = 0;
    for (const Entrant& entrant : entrants) {
        while (taken[place] != 0) ++place;
        position_.push_back(entrant.position);
        velocity_.push_back(entrant.velocity);
        pressure_.push_back(entrant.pressure);
        kind_.push_back(Kind::liquid);
        density_number_.push_back(reference_.number_density);
        id_.push_back(place++);
    }
    liquid_count_ += entrants.size();
}

namespace {

template <class T>
std::vector<T> in_given_order(const std::vector<T>& values, const std::vector<Index>& id,
                              std::size_t places, const T& vacant) {
    std::vector<T> out(places, vacant);
    for (std::size_t i = 0; i < values.size(); ++i) out[id[i]] = values[i];
    return out;
}

constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();

} // namespace

std::vector<Vec3> Liquid::of_liquid(const std::vector<Vec3>& values) const {
    std::vector<Vec3> out;
    out.reserve(liquid_count_);
    for (std::size_t i = 0; i < size(); ++i)
        if (kind_[i] == Kind::liquid) out.push_back(values[i]);
    return out;
}

std::vector<Vec3> Liquid::liquid_position() const {
    return of_liquid(position_);
}
std::vector<Vec3> Liquid::liquid_velocity() const {
    return of_liquid(velocity_);
}
std::vector<Vec3> Liquid::position() const {
    return in_given_order(position_, id_, places_, {nan, nan, nan});
}
std::vector<Vec3> Liquid::velocity() const {
    return in_given_order(velocity_, id_, places_, {nan, nan, nan});
}
std::vector<Kind> Liquid::kind() const {
    return in_given_order(kind_, id_, places_, Kind::liquid);
}
std::vector<Real> Liquid::pressure() const {
    return in_given_order(pressure_, id_, places_, nan);
}

template <class Value>
Real Liquid::mean_in_bore(const Value& value) const {
    Real sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < size(); ++i) {
        if (!counts(i)) continue;
        sum += value(i);
        ++count;
    }
    return sum / static_cast<Real>(count);
}

std::size_t Liquid::count_in_bore() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < size(); ++i) count += counts(i) ? 1 : 0;
    return count;
}

Real Liquid::bulk_velocity() const {
    return mean_in_bore([&](std::size_t i) { return velocity_[i].x; });
}

Real Liquid::kinetic_energy() const {
    return mean_in_bore([&](std::size_t i) { return dot(velocity_[i], velocity_[i]) / 2; });
}

std::vector<Real> Liquid::density_ratio() const {
    if (density_number_.empty()) return std::vector<Real>(places_, 1);
    const Real mean = mean_in_bore([&](std::size_t i) { return density_number_[i]; });
    std::vector<Real> ratio = in_given_order(density_number_, id_, places_, nan);
    for (Real& r : ratio) r /= mean;
    return ratio;
}

Real Liquid::density_scatter() const {
    const std::vector<Real> ratio = density_ratio();
    return std::sqrt(
        mean_in_bore([&](std::size_t i) { return (ratio[id_[i]] - 1) * (ratio[id_[i]] - 1); }));
}

Liquid::Snapshot Liquid::snapshot() const {
    Snapshot out{position_, velocity_, pressure_, {}, id_, ends_.state()};
    for (const Kind k : kind_) out.kind.push_back(static_cast<std::int8_t>(k));
    return out;
}

void Liquid::restore(const Snapshot& s) {
    const std::size_t n = s.position.size();
    const auto liquid = static_cast<std::size_t>(
        std::ranges::count(s.kind, static_cast<std::int8_t>(Kind::liquid)));
    const bool alike = ends_.periodic() ? n == size() : n <= places_;
    require(alike && s.velocity.size() == n && s.pressure.size() == n && s.kind.size() == n &&
                s.id.size() == n && n - liquid == size() - liquid_count_ &&
                std::ranges::all_of(s.id, [&](Index id) { return id < places_; }),
            "restore: the snapshot belongs to another liquid");
    ends_.restore(s.ends);
    if (!ends_.periodic()) wall_.place_plate(ends_.face());
    position_ = s.position;
    velocity_ = s.velocity;
    pressure_ = s.pressure;
    id_ = s.id;
    kind_.resize(n);
    for (std::size_t i = 0; i < n; ++i) kind_[i] = static_cast<Kind>(s.kind[i]);
    liquid_count_ = liquid;
    density_number_.clear();
    preconditioner_.reset();
}

} // namespace mpsdem::mps::lagrangian
