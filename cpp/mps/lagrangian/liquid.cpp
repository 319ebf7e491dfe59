#include "mps/lagrangian/liquid.hpp"

#include "core/check.hpp"
#include "core/ordered_sum.hpp"
#include "mps/divergence.hpp"
#include "mps/gradient.hpp"
#include "mps/least_squares_laplacian.hpp"
#include "mps/number_density.hpp"
#include "mps/relative_convection.hpp"
#include "mps/shear_rate.hpp"
#include "mps/shifting.hpp"
#include "mps/viscosity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace mpsdem::mps::lagrangian {

namespace {

constexpr Real reach = 2.1;         // [-] r_e over the spacing, for every operator
constexpr Real longest_shift = 0.1; // [-] spacings that a particle may be shifted in a step
constexpr Real viscous_limit = 0.1; // [-] largest nu dt / dx^2
constexpr Real most_substeps = 1e4; // [-] of one call; beyond it the speeds have run away
constexpr int most_halvings = 5;    // [-] of one call
constexpr Real spare_places = 0.05; // [-] of the liquid, for what a plate brings in
// [-] of a section's difference from the flux that it must have, made good in a step: the disorder
// of the particles that come and go is not followed, and a lasting difference does not build up
constexpr Real flux_feedback = 0.3;
constexpr Real fastest_over_bulk = 1.4; // [-] in clear turbulent flow; beyond it, solids narrow it
constexpr Real farthest_with_solids = 0.8; // [-] spacings that volume may go in a step, and twice
                                           // the way of the liquid past its particles
constexpr Real outlier = 8;                // [-] of the scatter of p', in a liquid with solids
constexpr int section_turns = 4;  // [-] of the same, where solids part the flux along the pipe
constexpr Real outlet_hold = 100; // [-] Dirichlet part over n0: p' is held to zero within a percent
constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();

/// Put the first order.size() values in an order.
template <class T>
void reorder(std::vector<T>& values, std::span<const Index> order, int threads,
             std::vector<T>& memory) {
    memory.resize(order.size());
    parallel_for(order.size(), threads, [&](std::size_t k) { memory[k] = values[order[k]]; });
    std::ranges::copy(memory, values.begin());
}

template <class T>
std::vector<T> in_given_order(std::span<const T> values, std::span<const Index> id,
                              std::size_t places, const T& vacant) {
    std::vector<T> out(places, vacant);
    for (std::size_t i = 0; i < values.size(); ++i) out[id[i]] = values[i];
    return out;
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

/// Number of liquid particles for which something holds; what decides may also change them.
template <class Holds>
std::size_t Liquid::count_liquid(const Holds& holds) const {
    return static_cast<std::size_t>(ordered_sum(liquid_count_, numerics_.threads,
                                                [&](std::size_t i) { return holds(i) ? 1. : 0.; }));
}

/// Mean over the liquid that is in the bore.
template <class Value>
Real Liquid::mean_in_bore(const Value& value) const {
    const auto sum_of = [&](const auto& term) {
        return ordered_sum(liquid_count_, numerics_.threads, [&](std::size_t i) {
            return ends_.in_bore(position_[i]) ? term(i) : Real{0};
        });
    };
    return sum_of(value) / sum_of([](std::size_t) { return Real{1}; });
}

/// Means of an axial flux over pieces of a length, where it has to be held: with a plate, or with
/// solids.
template <class Flux>
AxialBins Liquid::flux_of_sections(const Flux& flux) const {
    AxialBins bins = ends_.bins(section_length());
    if (ends_.periodic() && !loaded()) return bins;
    for (std::size_t i = 0; i < liquid_count_; ++i)
        if (moves(i)) bins.add(position_[i].x, flux(i));
    bins.take_means();
    return bins;
}

Liquid::Liquid(std::span<const Vec3> position, std::span<const Vec3> velocity,
               std::span<const Kind> kind, Real pipe_radius, Real pipe_length,
               const std::optional<PushPlate>& plate, Real density, Real kinematic_viscosity,
               Real roughness, Flow flow, const Drive& drive, const Numerics& numerics)
    : ends_(ends_of(pipe_length, plate, kind)),
      wall_(pipe_radius, plate ? ends_.face() : Bore::no_plate), pipe_radius_(pipe_radius),
      pipe_length_(pipe_length), density_(density), viscosity_(kinematic_viscosity), flow_(flow),
      drive_(drive), numerics_(numerics),
      reference_(numerics.particle_spacing, reach * numerics.particle_spacing),
      wall_function_(kinematic_viscosity, roughness), pairs_(reference_.weight, ends_.period()),
      cells_(position, reference_.weight.effective_radius, ends_.period(), numerics.threads),
      grid_(reference_.weight.effective_radius, ends_.period()),
      pressure_equation_(numerics.solver, numerics.tolerance, numerics.particle_spacing,
                         numerics.threads) {
    require(position.size() == velocity.size() && position.size() == kind.size(),
            "Liquid: position, velocity and kind must have the same length");
    require_drive(ends_, drive);
    require(!plate || plate->stroke >= 2 * numerics.particle_spacing,
            "PushPlate: stroke must be at least two particle spacings");
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
    places_ = size();
    volume_.assign(liquid_count_, std::numbers::pi * pipe_radius * pipe_radius * pipe_length /
                                      static_cast<Real>(liquid_count_));
    if (plate)
        places_ += static_cast<std::size_t>(spare_places * static_cast<Real>(liquid_count_)) + 1;
    for (std::size_t i = liquid_count_; i < size(); ++i) {
        if (!ends_.periodic() && wall_.of_plate(position_[i]))
            velocity_[i] = {ends_.plate_velocity(), 0, 0};
    }
    pressure_.assign(size(), 0);
    find_pairs();
    find_known();
    pressure_equation_.assemble(pairs_, pairs_.neighbors().position(), known_);
    pressure_equation_.prepare();

    // Ghosts keep their places behind the wall, and so do their shares.
    neighbors::NeighborList behind(reference_.weight.effective_radius, ends_.period());
    behind.find(std::span<const Vec3>(position_).subspan(liquid_count_), 1);
    behind_first_.push_back(0);
    for (std::size_t g = wall_count_; g < behind.rows(); ++g) {
        Real total = 0;
        behind.each(g, [&](Index w, const Vec3& r, Index) {
            if (w >= wall_count_) return;
            behind_column_.push_back(w);
            behind_share_.push_back(reference_.weight(norm(r)));
            total += behind_share_.back();
        });
        for (std::size_t k = behind_first_.back(); k < behind_share_.size(); ++k)
            behind_share_[k] /= total;
        behind_first_.push_back(static_cast<Index>(behind_column_.size()));
    }
}

void Liquid::drive(const Drive& drive) {
    require_drive(ends_, drive);
    drive_ = drive;
}

void Liquid::bend(const geometry::Bending& bending) {
    require(ends_.periodic() || bending.straight(), "bend: no plate in a pipe that moves");
    bending_ = bending;
    bend_to(0);
}

/// Walls, and all particles with them, where they are so long after the start of the advance.
void Liquid::bend_to(Real elapsed) {
    wall_.bend(bending_.at(elapsed));
    if (wall_.straight()) return;
    place_.resize(size());
    parallel_for(size(), numerics_.threads, [&](std::size_t i) {
        const auto axis = wall_.axis(position_[i].x);
        place_[i] = position_[i] + axis.displacement;
        if (i >= liquid_count_) velocity_[i] = axis.velocity;
    });
}

/// What is known of the liquid's motion beforehand: that of a plug which follows the axis. Walls
/// take the velocity of the end of the substep.
void Liquid::follow_axis(Real dt, Real elapsed) {
    const geometry::Bend later = bending_.at(elapsed + dt);
    const Real speed = drive_.bulk_velocity;
    shift_.resize(liquid_count_);
    plug_.resize(liquid_count_);
    parallel_for(size(), numerics_.threads, [&](std::size_t i) {
        const Real x = position_[i].x;
        if (i >= liquid_count_) {
            velocity_[i] = later.at(x).velocity;
            return;
        }
        const auto from = wall_.axis(x), to = later.at(x + speed * dt);
        plug_[i] = to.velocity + speed * to.slope;
        const Vec3 gain = plug_[i] - from.velocity - speed * from.slope;
        const Vec3 turn = to.turning + speed * to.curvature - from.turning - speed * from.curvature;
        velocity_[i] += Vec3{turn.y * position_[i].y + turn.z * position_[i].z, gain.y, gain.z};
        shift_[i] = {dot(gain, from.slope), 0, 0};
    });
    bending_loss_ = density_ / dt * mean_in_bore([&](std::size_t i) { return shift_[i].x; });
}

AdvanceReport Liquid::advance(Real dt, Loading* loading) {
    require(dt > 0, "advance: dt must be > 0 s");
    require(loading == nullptr || ends_.periodic(), "advance: no solids in a liquid with a plate");
    require(bending_.straight() || std::abs(bending_.duration() - dt) < 1e-6 * dt,
            "advance: dt must be the duration of the bending");
    AdvanceReport report;
    if (loading == nullptr) {
        eps_.clear();
        volume_flux_.clear();
        acceleration_of_last_.clear();
    }
    Real longest = dt;
    for (Real left = dt; left > 1e-9 * dt && report.sound;) {
        const Real count = std::ceil(left / std::min(stable_step(), longest) - 1e-9);
        if (!(count < most_substeps)) {
            report.sound = false;
            break;
        }
        const Real length = left / std::max(count, 1.);
        if (!step(length, report, loading, dt - left)) {
            longest = length / 2;
            report.sound = ++report.halvings <= most_halvings;
            continue;
        }
        left -= length;
        ++report.substeps;
        report.mean_gradient += (gradient_ + bending_loss_) * length / dt;
        report.bending += bending_loss_ * length / dt;
        report.friction += friction_ * length / dt;
        report.unexplained += unexplained_ * length / dt;
        report.convection_error += convection_error_ * length / dt;
    }
    load_ = {};  // it is the solids'
    bend_to(dt); // to the last bit, where the next advance begins
    return report;
}

Real Liquid::dynamic_pressure() const noexcept {
    Real speed = std::max(std::abs(drive_.bulk_velocity), numerics_.speed);
    if (loaded()) speed = std::max(speed, fastest_ / fastest_over_bulk);
    return density_ * speed * speed;
}

Real Liquid::fastest() const {
    Real square = 0;
    for (std::size_t i = 0; i < liquid_count_; ++i) {
        const Vec3 u = from_wall(i, velocity_[i]);
        square = std::max(square, dot(u, u));
    }
    return std::sqrt(square);
}

/// Largest step for the speeds and the molecular viscosity [s]; the eddy viscosity is cut to fit.
Real Liquid::stable_step() const {
    const Real dx = numerics_.particle_spacing;
    const Real speed =
        std::max({fastest(), ends_.plate_velocity(), std::numeric_limits<Real>::min()});
    return std::min(numerics_.courant * dx / speed, viscous_limit * dx * dx / viscosity_);
}

/// One substep; `false` and the state as before where the pressure could not be solved.
bool Liquid::step(Real dt, AdvanceReport& report, Loading* loading, Real elapsed) {
    sort();
    bend_to(elapsed);
    find_pairs();
    const Real carried_to = mean_momentum();
    load_ = loading == nullptr ? Load{} : loading->before(points(), elapsed, dt);
    if (loaded() && outruns(dt)) return false;
    velocity_before_ = velocity_;
    const Real before = mean_momentum();
    const AxialBins bins_before = flux_of_sections([&](std::size_t i) { return flux_before(i); });
    predict(dt, report);
    friction_ = density_ * (before - mean_momentum()) / dt;
    if (!wall_.straight()) follow_axis(dt, elapsed);
    if (loaded()) {
        fastest_ = fastest();
        // What the particles bring along by their motion, and the liquid that passes them, only
        // moves momentum from place to place: what is not so is given back.
        const Real brought = add_relative_convection(dt) + (eps_.empty() ? 0 : before - carried_to);
        convection_error_ = density_ * brought / dt;
        take_load(dt, brought);
        hold_sections(dt, bins_before);
    }
    if (!solve_pressure(dt, report)) {
        velocity_ = velocity_before_;
        return false;
    }
    correct(dt, bins_before);
    move(dt, report, elapsed);
    bend_to(elapsed + dt);
    if (!ends_.periodic()) move_plate(dt, report);
    if (loaded()) leave_load(dt, *loading);
    return true;
}

/// Whether the volume flux or the liquid past its particles would go too far in a step.
bool Liquid::outruns(Real dt) const {
    Real square = 0;
    for (std::size_t i = 0; i < liquid_count_; ++i) {
        const Vec3 flux = load_[i].void_fraction * velocity_[i] + load_[i].solids_flux;
        const Vec3 past = velocity_[i] - flux, gone = from_wall(i, flux);
        square = std::max({square, dot(gone, gone), 4 * dot(past, past)});
    }
    const Real farthest = std::max(numerics_.courant, farthest_with_solids);
    return std::sqrt(square) * dt > farthest * (1 + 1e-9) * numerics_.particle_spacing;
}

/// Share of the liquid at a particle, of the load where there is one [-].
Real Liquid::liquid_share(std::size_t i) const noexcept {
    if (loaded()) return load_[i].void_fraction;
    return eps_.empty() ? 1 : eps_[i];
}

/// Axial flux of the load under way, or of none, with the velocity of the substep's start [m/s].
Real Liquid::flux_before(std::size_t i) const noexcept {
    const Real u = velocity_before_[i].x;
    return loaded() ? load_[i].void_fraction * u + load_[i].solids_flux.x : u;
}

/// Mean of eps u_x in the bore [m/s].
Real Liquid::mean_momentum() const {
    return mean_in_bore([&](std::size_t i) { return liquid_share(i) * velocity_[i].x; });
}

/// Put neighbors in space near in memory.
void Liquid::sort() {
    const int threads = numerics_.threads;
    grid_.sort(std::span<const Vec3>(position_).first(liquid_count_), cells_, order_, threads);
    reorder(position_, order_, threads, shift_);
    reorder(velocity_, order_, threads, shift_);
    reorder(pressure_, order_, threads, scalar_);
    reorder(id_, order_, threads, id_memory_);
    load_ = {};
    if (eps_.empty()) return;
    reorder(eps_, order_, threads, scalar_);
    reorder(volume_flux_, order_, threads, shift_);
    reorder(acceleration_of_last_, order_, threads, shift_);
}

neighbors::Groups Liquid::groups() const {
    return {{liquid_count_, wall_count_, solids() - wall_count_}, liquid_count_ + wall_count_};
}

void Liquid::find_pairs() {
    pairs_.find(places_now(), groups(), numerics_.threads);
}

/// Viscosity and wall shear, on the liquid.
void Liquid::predict(Real dt, AdvanceReport& report) {
    const int threads = numerics_.threads;
    acceleration_.resize(liquid_count_);
    if (turbulent()) {
        find_eddy_viscosity(dt, report);
        parallel_for(load_.size(), threads,
                     [&](std::size_t i) { eddy_viscosity_[i] *= load_[i].void_fraction; });
        viscous_acceleration(reference_, pairs_, eddy_viscosity_, velocity_, threads,
                             acceleration_);
        parallel_for(load_.size(), threads, [&](std::size_t i) {
            acceleration_[i] = (1 / load_[i].void_fraction) * acceleration_[i];
        });
        add_wall_shear();
    } else {
        deficient_.resize(liquid_count_);
        if (wall_.straight())
            least_squares_laplacian<geometry::Cylinder, Vec3>(
                wall_, pairs_.neighbors(), kind_, velocity_, threads, acceleration_, deficient_);
        else
            least_squares_laplacian<geometry::BentCylinder, Vec3>(wall_.bent(), pairs_.neighbors(),
                                                                  kind_, velocity_, threads,
                                                                  acceleration_, deficient_);
        report.deficient += static_cast<std::size_t>(std::ranges::count(deficient_, 1));
        for (Vec3& a : acceleration_) a = viscosity_ * a;
        if (!ends_.periodic()) smooth_beside_plate();
    }
    parallel_for(liquid_count_, threads, [&](std::size_t i) {
        if (moves(i)) velocity_[i] += dt * acceleration_[i];
    });
}

/// What the liquid brings along that passes its particles; returns by how much that changed the
/// mean of eps u_x in the bore, which it should not [m/s].
Real Liquid::add_relative_convection(Real dt) {
    const Load load = load_;
    const int threads = numerics_.threads;
    shift_.resize(liquid_count_);
    scalar_.resize(liquid_count_);
    parallel_for(liquid_count_, threads, [&](std::size_t i) {
        const Real eps = scalar_[i] = load[i].void_fraction;
        shift_[i] = eps * ((1 - eps) * velocity_before_[i] - load[i].solids_flux); // eps (u - w)
    });
    relative_convection(reference_, pairs_, shift_, scalar_, velocity_before_, threads,
                        acceleration_);
    parallel_for(liquid_count_, threads,
                 [&](std::size_t i) { velocity_[i] += dt * acceleration_[i]; });
    return dt * mean_in_bore([&](std::size_t i) { return liquid_share(i) * acceleration_[i].x; });
}

/// From the liquid's velocity to the volume flux, with the drag of the solids in it; the list
/// becomes the matrix of the damped pressure.
void Liquid::take_load(Real dt, Real brought) {
    const Load load = load_;
    const int threads = numerics_.threads;
    damping_.assign(pairs_.rows(), 1);
    parallel_for(liquid_count_, threads, [&](std::size_t i) {
        const Real eps = load[i].void_fraction;
        damping_[i] = 1 / (1 + dt * load[i].drag / (density_ * eps));
        const Vec3 momentum = eps * velocity_[i] - Vec3{brought, 0, 0};
        velocity_[i] = damping_[i] * (momentum + (dt / density_) * load[i].drag_of_solids) +
                       load[i].solids_flux;
    });
    // A wall's share in the pressure is damped as the liquid's before it.
    parallel_for(wall_count_, threads, [&](std::size_t w) {
        Real sum = 0, weights = 0;
        pairs_.each<Among::liquid>(liquid_count_ + w, [&](const Pair& p) {
            sum += p.weight * damping_[p.j];
            weights += p.weight;
        });
        if (weights > 0) damping_[liquid_count_ + w] = sum / weights;
    });
    pairs_.scale_weights(damping_, threads);
}

/// The axial gradient, a function of x, that gives each section back what drag and walls took from
/// its flux in this step, and brings it nearer to the flux of the bore.
void Liquid::hold_sections(Real dt, const AxialBins& before) {
    const AxialBins damping = flux_of_sections([&](std::size_t i) { return damping_[i]; });
    const Real aim = mean_in_bore([&](std::size_t i) { return before.at(position_[i].x); });
    scalar_.assign(liquid_count_, 0);
    // The broken line through a section's means has other means itself: what is left of them goes
    // the same way again.
    for (int turn = 0; turn < section_turns; ++turn) {
        const AxialBins lost = flux_of_sections([&](std::size_t i) {
            const Real was = flux_before(i);
            return was + flux_feedback * (aim - was) - velocity_[i].x;
        });
        parallel_for(liquid_count_, numerics_.threads, [&](std::size_t i) {
            const Real x = position_[i].x, push = lost.at(x) / damping.at(x);
            scalar_[i] += push;
            velocity_[i].x += damping_[i] * push;
        });
    }
    gradient_ = density_ / dt * mean_in_bore([&](std::size_t i) { return scalar_[i]; });

    // Across the pipe the mean flux is nil: a uniform gradient undoes what drag does to it, as one
    // undoes gravity, and the solver need not.
    const Real open = mean_in_bore([&](std::size_t i) { return damping_[i]; });
    const auto from_axis = [&](std::size_t i) {
        return wall_.straight() ? velocity_[i] : velocity_[i] - plug_[i];
    };
    const Vec3 across{0, mean_in_bore([&](std::size_t i) { return from_axis(i).y; }) / open,
                      mean_in_bore([&](std::size_t i) { return from_axis(i).z; }) / open};
    parallel_for(liquid_count_, numerics_.threads,
                 [&](std::size_t i) { velocity_[i] -= damping_[i] * across; });
}

/// From the volume flux back to the liquid's velocity; what the solids still owe is paid.
void Liquid::leave_load(Real dt, Loading& loading) {
    const Load load = load_;
    const int threads = numerics_.threads;
    volume_flux_.resize(liquid_count_);
    acceleration_of_last_.resize(liquid_count_);
    eps_.resize(liquid_count_);
    parallel_for(liquid_count_, threads, [&](std::size_t i) {
        eps_[i] = load[i].void_fraction;
        volume_flux_[i] = velocity_[i];
        velocity_[i] = (1 / eps_[i]) * (velocity_[i] - load[i].solids_flux);
        const Vec3 drag =
            (1 / (density_ * eps_[i])) * (load[i].drag_of_solids - load[i].drag * velocity_[i]);
        acceleration_of_last_[i] = (1 / dt) * (velocity_[i] - velocity_before_[i]) - drag;
    });
    const std::span<const Vec3> owed = loading.owed(liquid_velocity());
    parallel_for(liquid_count_, threads,
                 [&](std::size_t i) { velocity_[i] += (1 / (density_ * eps_[i])) * owed[i]; });
}

/// Within a radius of the plate, where liquid is pressed together and turned round, polynomials
/// through the neighbors lose their hold: there only the pairwise sum, which can but smooth.
void Liquid::smooth_beside_plate() {
    eddy_viscosity_.assign(liquid_count_, viscosity_);
    shift_.resize(liquid_count_);
    viscous_acceleration(reference_, pairs_, eddy_viscosity_, velocity_, numerics_.threads, shift_);
    const Real end = ends_.face() + pipe_radius_;
    for (std::size_t i = 0; i < liquid_count_; ++i)
        if (position_[i].x < end) acceleration_[i] = shift_[i];
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
                eddy_viscosity(model, std::span<const Vec3>(position_).first(liquid_count_),
                               scalar_, largest, threads, eddy_viscosity_);
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
        const Real distance = wall_.at(places_now()[i]).distance;
        scalar_[i] = outside_the_layer;
        if (distance >= dx || !moves(i)) return;
        const Real speed = norm(from_wall(i, velocity_[i]));
        const Real y = std::max(distance, nearest_liquid * dx);
        scalar_[i] = speed == 0 ? 0 : wall_function_.shear(speed, y) / speed; // [1/s m]
    });
    std::size_t layer = 0, liquid = 0;
    Real sum = 0; // of shear over density
    for (std::size_t i = 0; i < liquid_count_; ++i) {
        liquid += moves(i) ? 1 : 0;
        if (scalar_[i] == outside_the_layer) continue;
        ++layer;
        sum += scalar_[i] * velocity_[i].x;
    }
    if (layer == 0) return;
    const auto count = static_cast<Real>(layer);
    // wall area over the layer's volume: 2 pi R L / (count pi R^2 L / liquid)
    const Real per_volume = 2 * static_cast<Real>(liquid) / (pipe_radius_ * count);
    parallel_for(liquid_count_, threads, [&](std::size_t i) {
        if (scalar_[i] != outside_the_layer)
            acceleration_[i] -= (per_volume * scalar_[i]) * from_wall(i, velocity_[i]);
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
        right_hand_side_[i] = moves(i) ? scale * right_hand_side_[i] : 0;
    });
    remove_axial_bias();
    pressure_before_.assign(pressure_.begin(),
                            pressure_.begin() + static_cast<std::ptrdiff_t>(unknowns));
    find_known();
    const bool straight = wall_.straight();
    pressure_equation_.assemble(
        pairs_, straight ? pairs_.neighbors().position() : std::span<const Vec3>(position_),
        known_);
    if (!pressure_equation_.solve(right_hand_side_, std::span(pressure_).first(unknowns),
                                  report.solve)) {
        std::ranges::copy(pressure_before_, pressure_.begin());
        return false;
    }
    cut_pressure(report);
    extrapolate_pressure();
    return true;
}

/// Behind the outlet p' is held to zero.
void Liquid::find_known() {
    known_.clear();
    if (ends_.periodic()) return;
    known_.assign(pairs_.rows(), 0);
    for (std::size_t i = 0; i < pairs_.rows(); ++i)
        if (!ends_.inside(position_[i])) known_[i] = outlet_hold * reference_.number_density;
}

/// The disorder of the particles leaves in the source a random axial wave, which the solve would
/// amplify with the length of the pipe. In a full rigid pipe the flux through every section is the
/// same, and a plate's too: the source's mean over each diameter of length is zero, and is made so.
void Liquid::remove_axial_bias() {
    AxialBins bias = ends_.bins(section_length());
    for (std::size_t i = 0; i < liquid_count_; ++i)
        if (moves(i)) bias.add(pairs_.position(i).x, right_hand_side_[i]);
    bias.take_means();
    parallel_for(liquid_count_, numerics_.threads, [&](std::size_t i) {
        if (moves(i)) right_hand_side_[i] -= bias.at(pairs_.position(i).x);
    });
}

/// Cut p' to the limit about its mean in the liquid, which is zero where nothing holds it.
void Liquid::cut_pressure(AdvanceReport& report) {
    const int threads = numerics_.threads;
    const auto count = static_cast<Real>(liquid_count_);
    const Real mean =
        ordered_sum(liquid_count_, threads, [&](std::size_t i) { return pressure_[i]; }) / count;
    Real limit = std::numeric_limits<Real>::infinity();
    if (turbulent() && dynamic_pressure() > 0)
        limit = numerics_.pressure_limit * dynamic_pressure();
    if (loaded()) { // what solids do to it is not known beforehand, but an outlier stands out
        const auto square = [&](std::size_t i) {
            return (pressure_[i] - mean) * (pressure_[i] - mean);
        };
        limit += outlier * std::sqrt(ordered_sum(liquid_count_, threads, square) / count);
    }
    report.clamped +=
        count_liquid([&](std::size_t i) { return std::abs(pressure_[i] - mean) > limit; });
    const Real level = ends_.periodic() ? 0 : mean;
    parallel_for(pairs_.rows(), threads, [&](std::size_t i) {
        pressure_[i] = level + std::clamp(pressure_[i] - mean, -limit, limit);
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
            sum += behind_share_[k] * pressure_[liquid_count_ + behind_column_[k]];
        pressure_[first_ghost + g] = sum;
    });
}

/// Gradient of p', then what drives the liquid along the pipe.
void Liquid::correct(Real dt, const AxialBins& before) {
    background_gradient(numerics_.pairing, numerics_.background * dynamic_pressure(), wall_,
                        reference_, pairs_, pressure_, numerics_.threads, acceleration_);
    const auto damping = [&](std::size_t i) { return loaded() ? damping_[i] : 1; };
    parallel_for(liquid_count_, numerics_.threads, [&](std::size_t i) {
        if (moves(i)) velocity_[i] -= (damping(i) * dt / density_) * acceleration_[i];
    });
    const Real mean = mean_in_bore([&](std::size_t i) { return acceleration_[i].x; });
    unexplained_ = -mean;
    if (ends_.periodic())
        hold_bulk_velocity(dt);
    else
        hold_flux_of_plate(dt, before);
}

/// The mean axial gradient: given, or what holds the bulk velocity.
void Liquid::hold_bulk_velocity(Real dt) {
    const auto bulk = [&] { return mean_in_bore([&](std::size_t i) { return velocity_[i].x; }); };
    const Real known = loaded() ? gradient_ : 0; // that of the sections
    Real open = 1;                               // of the liquid to a gradient
    if (loaded()) open = mean_in_bore([&](std::size_t i) { return damping_[i]; });
    const Real missing = drive_.pressure_gradient
                             ? *drive_.pressure_gradient - known
                             : density_ * (drive_.bulk_velocity - bulk()) / (dt * open);
    gradient_ = known + missing;
    const Real kick = dt * missing / density_;
    parallel_for(liquid_count_, numerics_.threads,
                 [&](std::size_t i) { velocity_[i].x += loaded() ? damping_[i] * kick : kick; });
}

/// The axial gradient that gives each section back what it lost in this step, and brings it nearer
/// to the plate's velocity. The loss of pressure along the bore is its mean and what p' falls.
void Liquid::hold_flux_of_plate(Real dt, const AxialBins& before) {
    const AxialBins after = flux_of_sections([&](std::size_t i) { return velocity_[i].x; });
    const Real aim = ends_.plate_velocity();
    scalar_.resize(liquid_count_);
    parallel_for(liquid_count_, numerics_.threads, [&](std::size_t i) {
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

/// Move with the velocity, and shift towards where particles are few. The shift goes with the way
/// that the liquid makes: disorder comes from it, and a shift of every step, however short, would
/// mix the momentum of a flow whose steps viscosity limits.
void Liquid::move(Real dt, AdvanceReport& report, Real elapsed) {
    const geometry::Bend later = bending_.at(elapsed + dt);
    const Real speed = drive_.bulk_velocity;
    const Real dx = numerics_.particle_spacing;
    const Real longest = longest_shift * dx;
    const Real way = fastest() * dt / dx;
    shift_.resize(liquid_count_);
    shifting(numerics_.shift * way, reference_, pairs_, numerics_.threads, shift_);
    if (!ends_.periodic()) {
        for (std::size_t i = 0; i < liquid_count_; ++i)
            if (!moves(i)) shift_[i] = {};
    }
    report.shifts_cut += count_liquid([&](std::size_t i) {
        const Real length = norm(shift_[i]);
        if (length > longest) shift_[i] = (longest / length) * shift_[i];
        return length > longest;
    });
    const Real farthest = pipe_radius_ - nearest_liquid * dx;
    report.held_back += count_liquid([&](std::size_t i) {
        Vec3 x = pairs_.position(i) + dt * velocity_[i] + shift_[i];
        if (!later.straight()) {
            // as far as the axis goes, and not as its last velocity would carry it
            const Real along = position_[i].x;
            x += later.at(along + speed * dt).displacement - wall_.axis(along).displacement -
                 dt * plug_[i];
            x -= later.at(x.x).displacement;
        }
        const Real r2 = x.y * x.y + x.z * x.z;
        const bool beyond = r2 > farthest * farthest;
        if (beyond) {
            const Real inwards = farthest / std::sqrt(r2);
            x.y *= inwards;
            x.z *= inwards;
        }
        if (ends_.periodic()) {
            x.x -= std::floor(x.x / pipe_length_) * pipe_length_;
            if (x.x >= pipe_length_) x.x = 0; // rounded up from just below zero
        }
        position_[i] = x;
        return beyond;
    });
    const std::size_t lost = count_liquid([&](std::size_t i) {
        return !std::isfinite(dot(velocity_[i], velocity_[i]) + dot(position_[i], position_[i]));
    });
    report.sound = report.sound && lost == 0;
}

/// The plate goes on, ahead of the liquid next to it, and at the end of its stroke jumps back; what
/// has passed the outlet is dropped.
void Liquid::move_plate(Real dt, AdvanceReport& report) {
    const auto carry = [&](Real distance) {
        for (std::size_t i = liquid_count_; i < size(); ++i)
            if (wall_.of_plate(position_[i])) position_[i].x += distance;
    };
    const Real from = ends_.face();
    ends_.advance(dt);
    carry(ends_.face() - from);
    const Real nearest = ends_.face() + nearest_liquid * numerics_.particle_spacing;
    std::vector<std::uint8_t> kept(liquid_count_, 1);
    for (std::size_t i = 0; i < liquid_count_; ++i) {
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
        kept.assign(liquid_count_, 1);
        for (std::size_t i = 0; i < liquid_count_; ++i) {
            if (position_[i].x < seam) {
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

/// Drop the liquid that is not to be kept.
void Liquid::keep(const std::vector<std::uint8_t>& kept) {
    std::size_t next = 0;
    for (std::size_t i = 0; i < liquid_count_; ++i) {
        if (kept[i] == 0) continue;
        position_[next] = position_[i];
        velocity_[next] = velocity_[i];
        pressure_[next] = pressure_[i];
        id_[next++] = id_[i];
    }
    resize_liquid(next);
}

/// New liquid, in the first places that are free.
void Liquid::enter(std::span<const Entrant> entrants) {
    std::vector<std::uint8_t> taken(places_, 0);
    for (const Index id : id_) taken[id] = 1;
    std::size_t at = liquid_count_;
    resize_liquid(liquid_count_ + entrants.size());
    Index place = 0;
    for (const Entrant& entrant : entrants) {
        while (taken[place] != 0) ++place;
        position_[at] = entrant.position;
        velocity_[at] = entrant.velocity;
        pressure_[at] = entrant.pressure;
        id_[at++] = place++;
    }
}

/// Make room before the walls, or close it.
void Liquid::resize_liquid(std::size_t count) {
    const auto resize = [&]<class T>(std::vector<T>& values, const T& value) {
        const auto end = values.begin() + static_cast<std::ptrdiff_t>(liquid_count_);
        if (count < liquid_count_)
            values.erase(values.begin() + static_cast<std::ptrdiff_t>(count), end);
        else
            values.insert(end, count - liquid_count_, value);
    };
    resize(position_, Vec3{});
    resize(velocity_, Vec3{});
    resize(pressure_, Real{0});
    resize(id_, Index{0});
    resize(kind_, Kind::liquid);
    liquid_count_ = count;
}

std::vector<Vec3> Liquid::position() const {
    return in_given_order<Vec3>(places_now(), id_, places_, {nan, nan, nan});
}
std::vector<Vec3> Liquid::velocity() const {
    return in_given_order<Vec3>(velocity_, id_, places_, {nan, nan, nan});
}
std::vector<Kind> Liquid::kind() const {
    return in_given_order<Kind>(kind_, id_, places_, Kind::liquid);
}
std::vector<Real> Liquid::pressure() const {
    return in_given_order<Real>(pressure_, id_, places_, nan);
}

std::size_t Liquid::count_in_bore() const {
    return count_liquid([&](std::size_t i) { return ends_.in_bore(position_[i]); });
}

std::vector<Real> Liquid::void_fraction() const {
    std::vector<Real> eps(size(), 1);
    std::ranges::copy(eps_, eps.begin());
    return in_given_order<Real>(eps, id_, places_, nan);
}

Real Liquid::bulk_velocity() const {
    const std::vector<Vec3>& flux = volume_flux_.empty() ? velocity_ : volume_flux_;
    return mean_in_bore([&](std::size_t i) { return flux[i].x; });
}

Real Liquid::kinetic_energy() const {
    const auto share = [&](std::size_t i) { return eps_.empty() ? 1 : eps_[i]; };
    const auto square = [&](std::size_t i) {
        const Vec3 u = from_wall(i, velocity_[i]);
        return dot(u, u);
    };
    return mean_in_bore([&](std::size_t i) { return share(i) * square(i) / 2; }) /
           mean_in_bore(share);
}

/// Number density over its mean in the liquid, of liquid and wall as they are now.
std::vector<Real> Liquid::number_ratio() const {
    StoredPairs now(reference_.weight, ends_.period());
    now.find(places_now(), groups(), numerics_.threads);
    std::vector<Real> ratio(now.rows());
    number_density(now, numerics_.threads, ratio);
    const Real mean = mean_in_bore([&](std::size_t i) { return ratio[i]; });
    for (Real& r : ratio) r /= mean;
    return ratio;
}

std::vector<Real> Liquid::density_ratio() const {
    return in_given_order<Real>(number_ratio(), id_, places_, nan);
}

Real Liquid::density_scatter() const {
    const std::vector<Real> ratio = number_ratio();
    return std::sqrt(mean_in_bore([&](std::size_t i) { return (ratio[i] - 1) * (ratio[i] - 1); }));
}

void Liquid::restore(const Snapshot& s) {
    const std::size_t n = s.position.size();
    const bool alike = ends_.periodic() ? n == size() : n <= places_ && n > solids();
    require(alike && s.velocity.size() == n && s.pressure.size() == n && s.id.size() == n &&
                std::ranges::all_of(s.id, [&](Index id) { return id < places_; }),
            "restore: the snapshot belongs to another liquid");
    const std::size_t in_load = s.void_fraction.size();
    require((in_load == 0 || in_load == liquid_count_) && s.acceleration.size() == in_load &&
                s.flux.size() == in_load,
            "restore: the snapshot's load belongs to another liquid");
    ends_.restore(s.ends); // first, as it may refuse
    resize_liquid(n - solids());
    if (!ends_.periodic()) wall_.place_plate(ends_.face());
    position_ = s.position;
    velocity_ = s.velocity;
    pressure_ = s.pressure;
    id_ = s.id;
    acceleration_of_last_ = s.acceleration;
    volume_flux_ = s.flux;
    eps_ = s.void_fraction;
    load_ = {};
}

} // namespace mpsdem::mps::lagrangian
