#include "coupling/exchange.hpp"

#include "core/check.hpp"
#include "core/field.hpp"
#include "core/ordered_sum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace mpsdem::coupling {

namespace {

void require_places(std::span<const Vec3> position, Real period) {
    for (std::size_t p = 0; p < position.size(); ++p) {
        const Vec3& x = position[p];
        require(std::isfinite(x.x + x.y + x.z) && (period == 0 || (x.x >= 0 && x.x < period)),
                "Exchange: position of solid " + std::to_string(p) +
                    " must be finite, and its x from 0 to less than the period");
    }
}

} // namespace

Exchange::Exchange(Real smoothing_radius, Real liquid_density, int threads)
    : footprints_(SmoothingKernel{smoothing_radius}), density_(liquid_density), threads_(threads) {
    require(std::isfinite(smoothing_radius) && smoothing_radius > 0,
            "Exchange: smoothing_radius must be > 0 m");
    require(std::isfinite(liquid_density) && liquid_density > 0,
            "Exchange: liquid_density must be > 0 kg/m3");
    require(threads >= 1, "Exchange: threads must be >= 1");
}

void Exchange::begin(const mps::LiquidPoints& points, std::span<const Vec3> velocity,
                     std::span<const Vec3> acceleration, std::span<const Vec3> position,
                     std::span<const Real> radius) {
    require(velocity.size() == points.position.size() &&
                (acceleration.empty() || acceleration.size() == velocity.size()),
            "Exchange: the liquid needs a velocity for each of its points");
    require(radius.size() == position.size(), "Exchange: radius must have one row per solid");
    require_places(position, points.period);
    given_ = false;
    volume_.resize(position.size());
    for (std::size_t p = 0; p < position.size(); ++p)
        volume_[p] = 4. / 3 * std::numbers::pi * radius[p] * radius[p] * radius[p];
    points_ = points;
    field_ = velocity;
    footprints_.find(points, position, threads_);
    velocity_.resize(position.size());
    acceleration_.assign(position.size(), {});
    parallel_for(position.size(), threads_, [&](std::size_t p) {
        velocity_[p] = footprints_.sample(p, velocity);
        if (!acceleration.empty()) acceleration_[p] = footprints_.sample(p, acceleration);
    });
    find_touched();
}

/// The points that solids act on, and what an impulse there does to the liquid.
void Exchange::find_touched() {
    per_mass_.resize(points_.position.size());
    load_.resize(per_mass_.size());
    parallel_for(per_mass_.size(), threads_, [&](std::size_t i) { per_mass_[i] = 0; });
    footprints_.spread(threads_, [&](std::size_t p) {
        footprints_.each(p, [&](Index i, Real w) { per_mass_[i] += w * volume_[p]; });
    });
    touched_.clear();
    for (std::size_t i = 0; i < per_mass_.size(); ++i) {
        if (per_mass_[i] == 0) continue;
        const Real volume = points_.volume[i];
        const Real eps = std::max(1 - per_mass_[i] / volume, least_void_fraction);
        per_mass_[i] = 1 / (density_ * volume * eps);
        touched_.push_back(static_cast<Index>(i));
    }
}

Response Exchange::response(std::span<const Real> drag, std::span<const Vec3> velocity) {
    require(!given_, "Exchange: begin comes before response");
    require(drag.size() == volume_.size() && velocity.size() == volume_.size(),
            "Exchange: drag and velocity must have one row per solid");
    parallel_for(touched_.size(), threads_, [&](std::size_t k) { load_[touched_[k]] = {}; });
    footprints_.spread(threads_, [&](std::size_t p) {
        const Vec3 force = drag[p] * velocity[p];
        footprints_.each(p, [&](Index i, Real w) {
            load_[i].drag += w * drag[p];
            load_[i].drag_of_solids += w * force;
        });
    });
    // to what drag does to the liquid at each point: its relaxation and its acceleration
    parallel_for(touched_.size(), threads_, [&](std::size_t k) {
        const Index i = touched_[k];
        mps::LoadAt& at = load_[i];
        at.drag_of_solids = per_mass_[i] * (at.drag_of_solids - at.drag * field_[i]);
        at.drag = per_mass_[i] * at.drag;
    });
    Response result;
    result.relaxation.resize(drag.size());
    result.acceleration.resize(drag.size());
    parallel_for(drag.size(), threads_, [&](std::size_t p) {
        Real rate = 0;
        Vec3 by_drag;
        footprints_.each(p, [&](Index i, Real w) {
            rate += w * load_[i].drag;
            by_drag += w * load_[i].drag_of_solids;
        });
        result.relaxation[p] = rate;
        result.acceleration[p] = acceleration_[p] + by_drag + rate * (velocity_[p] - velocity[p]);
    });
    return result;
}

void Exchange::give(const SolidsStep& step) {
    const std::size_t n = volume_.size();
    require(step.position.size() == n && step.mean_velocity.size() == n && step.drag.size() == n &&
                (step.impulse.empty() || step.impulse.size() == n),
            "Exchange: position, mean_velocity, drag and impulse must have one row per solid");
    require(step.duration > 0, "Exchange: duration must be > 0 s");
    require(!given_, "Exchange: begin comes before give");
    given_ = true;
    start_.assign(step.position.begin(), step.position.end());
    mean_velocity_.assign(step.mean_velocity.begin(), step.mean_velocity.end());
    drag_.assign(step.drag.begin(), step.drag.end());
    impulse_.assign(step.impulse.begin(), step.impulse.end());
    free_ = !step.impulse.empty();
    duration_ = step.duration;
    received_.assign(n, {});
    clipped_ = 0;
    on_liquid_ = on_solids_ = {};
    sizes_ = 0;
}

mps::Load Exchange::before(const mps::LiquidPoints& points, Real elapsed, Real dt) {
    require(given_ && elapsed + dt <= duration_ * (1 + 1e-6),
            "Exchange: give, for the whole step of the liquid, comes before its advance");
    points_ = points;
    step_ = dt;
    position_.resize(start_.size());
    for (std::size_t p = 0; p < start_.size(); ++p) {
        Vec3 x = start_[p] + elapsed * mean_velocity_[p];
        if (points.period > 0) {
            x.x -= std::floor(x.x / points.period) * points.period;
            if (x.x >= points.period) x.x = 0; // rounded up from just below zero
        }
        position_[p] = x;
    }
    footprints_.find(points, position_, threads_);
    load_.resize(points.position.size());
    parallel_for(load_.size(), threads_, [&](std::size_t i) { load_[i] = {}; });
    // sums over solids first: the volume of solids [m3] stands for the void fraction
    footprints_.spread(threads_, [&](std::size_t p) {
        const Vec3 &v = mean_velocity_[p], flux = volume_[p] * v, force = drag_[p] * v;
        footprints_.each(p, [&](Index i, Real w) {
            mps::LoadAt& at = load_[i];
            at.void_fraction += w * volume_[p];
            at.drag += w * drag_[p];
            at.solids_flux += w * flux;
            at.drag_of_solids += w * force;
        });
    });
    // bore, liquid and how many were raised to the floor
    const Vec3 sums = ordered_sum<Vec3>(load_.size(), threads_, [&](std::size_t i) {
        mps::LoadAt& at = load_[i];
        const Real volume = points_.volume[i], per_volume = 1 / volume;
        const Real unclipped = 1 - per_volume * at.void_fraction;
        const Real eps = std::max(unclipped, least_void_fraction);
        at.void_fraction = eps;
        at.drag *= per_volume;
        at.solids_flux = per_volume * at.solids_flux;
        at.drag_of_solids = per_volume * at.drag_of_solids;
        return Vec3{volume, volume * eps, unclipped < eps ? 1. : 0.};
    });
    clipped_now_ = static_cast<std::size_t>(sums.z);
    liquid_volume_error_ = sums.y / (sums.x - total(volume_)) - 1;
    return load_;
}

std::span<const Vec3> Exchange::owed(std::span<const Vec3> velocity) {
    clipped_ += clipped_now_;
    got_.resize(start_.size());
    rest_.resize(start_.size());
    parallel_for(start_.size(), threads_, [&](std::size_t p) {
        const Vec3 by_drag =
            (drag_[p] * step_) * (footprints_.sample(p, velocity) - mean_velocity_[p]);
        got_[p] = free_ ? (step_ / duration_) * impulse_[p] : by_drag;
        rest_[p] = by_drag - got_[p];
    });
    for (std::size_t p = 0; p < start_.size(); ++p) {
        received_[p] += got_[p];
        on_solids_ += got_[p];
        sizes_ += norm(got_[p]);
    }
    owed_.resize(velocity.size());
    parallel_for(owed_.size(), threads_, [&](std::size_t i) { owed_[i] = {}; });
    if (free_) {
        footprints_.spread(threads_, [&](std::size_t p) {
            footprints_.each(p, [&](Index i, Real w) { owed_[i] += w * rest_[p]; });
        });
    }
    on_liquid_ += ordered_sum<Vec3>(owed_.size(), threads_, [&](std::size_t i) {
        const mps::LoadAt& at = load_[i];
        const Vec3 owed = owed_[i];
        owed_[i] = (1 / points_.volume[i]) * owed;
        return owed + (points_.volume[i] * step_) * (at.drag_of_solids - at.drag * velocity[i]);
    });
    return owed_;
}

Real Exchange::mismatch() const noexcept {
    return sizes_ > 0 ? norm(on_liquid_ + on_solids_) / sizes_ : 0;
}

} // namespace mpsdem::coupling
