#include "coupling/exchange.hpp"

#include "core/check.hpp"

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

Exchange::Exchange(Real smoothing_radius, Real liquid_density)
    : footprints_(SmoothingKernel{smoothing_radius}), density_(liquid_density) {
    require(std::isfinite(smoothing_radius) && smoothing_radius > 0,
            "Exchange: smoothing_radius must be > 0 m");
    require(std::isfinite(liquid_density) && liquid_density > 0,
            "Exchange: liquid_density must be > 0 kg/m3");
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
    footprints_.find(points, position);
    at_point_.assign(points.position.size(), {});
    for (std::size_t p = 0; p < position.size(); ++p)
        footprints_.each(p, [&](Index i, Real w) { at_point_[i].volume += w * volume_[p]; });
    find_void_fraction(points);
    velocity_.resize(position.size());
    acceleration_.assign(position.size(), {});
    for (std::size_t p = 0; p < position.size(); ++p) {
        velocity_[p] = footprints_.sample(p, velocity);
        if (!acceleration.empty()) acceleration_[p] = footprints_.sample(p, acceleration);
    }
}

/// Void fractions from the volume of solids at each point [m3].
void Exchange::find_void_fraction(const mps::LiquidPoints& points) {
    void_fraction_.resize(points.position.size());
    clipped_now_ = 0;
    Real bore = 0, liquid = 0, solids = 0;
    for (std::size_t i = 0; i < void_fraction_.size(); ++i) {
        Real eps = 1 - at_point_[i].volume / points.volume[i];
        if (eps < least_void_fraction) {
            eps = least_void_fraction;
            ++clipped_now_;
        }
        void_fraction_[i] = eps;
        bore += points.volume[i];
        liquid += points.volume[i] * eps;
    }
    for (const Real volume : volume_) solids += volume;
    liquid_volume_error_ = liquid / (bore - solids) - 1;
}

Response Exchange::response(std::span<const Real> drag, std::span<const Vec3> velocity) {
    require(!given_, "Exchange: begin comes before response");
    require(drag.size() == volume_.size() && velocity.size() == volume_.size(),
            "Exchange: drag and velocity must have one row per solid");
    std::vector<AtPoint>& at = at_point_;
    for (std::size_t p = 0; p < drag.size(); ++p)
        footprints_.each(p, [&](Index i, Real) { at[i] = {}; });
    for (std::size_t p = 0; p < drag.size(); ++p) {
        const Vec3 force = drag[p] * velocity[p];
        footprints_.each(p, [&](Index i, Real w) {
            at[i].drag += w * drag[p];
            at[i].force += w * force;
        });
    }
    Response result;
    result.relaxation.reserve(drag.size());
    result.acceleration.reserve(drag.size());
    for (std::size_t p = 0; p < drag.size(); ++p) {
        Real rate = 0;
        Vec3 by_drag;
        footprints_.each(p, [&](Index i, Real w) {
            const Real share = w / (density_ * points_.volume[i] * void_fraction_[i]);
            rate += share * at[i].drag;
            by_drag += share * (at[i].force - at[i].drag * field_[i]);
        });
        result.relaxation.push_back(rate);
        result.acceleration.push_back(acceleration_[p] + by_drag +
                                      rate * (velocity_[p] - velocity[p]));
    }
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
    footprints_.find(points, position_);
    const std::size_t n = points.position.size();
    at_point_.assign(n, {});
    for (std::size_t p = 0; p < start_.size(); ++p) {
        const Vec3 &v = mean_velocity_[p], flux = volume_[p] * v, force = drag_[p] * v;
        footprints_.each(p, [&](Index i, Real w) {
            AtPoint& at = at_point_[i];
            at.volume += w * volume_[p];
            at.drag += w * drag_[p];
            at.flux += w * flux;
            at.force += w * force;
        });
    }
    find_void_fraction(points);
    flux_.resize(n);
    beta_.resize(n);
    drag_of_solids_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Real per_volume = 1 / points.volume[i];
        beta_[i] = per_volume * at_point_[i].drag;
        flux_[i] = per_volume * at_point_[i].flux;
        drag_of_solids_[i] = per_volume * at_point_[i].force;
    }
    return {void_fraction_, flux_, beta_, drag_of_solids_};
}

std::span<const Vec3> Exchange::owed(std::span<const Vec3> velocity) {
    owed_.assign(velocity.size(), {});
    clipped_ += clipped_now_;
    for (std::size_t p = 0; p < start_.size(); ++p) {
        const Vec3 by_drag =
            (drag_[p] * step_) * (footprints_.sample(p, velocity) - mean_velocity_[p]);
        const Vec3 got = free_ ? (step_ / duration_) * impulse_[p] : by_drag;
        if (free_) {
            const Vec3 rest = by_drag - got;
            footprints_.each(p, [&](Index i, Real w) { owed_[i] += w * rest; });
        }
        received_[p] += got;
        on_solids_ += got;
        sizes_ += norm(got);
    }
    for (std::size_t i = 0; i < velocity.size(); ++i) {
        owed_[i] = (1 / points_.volume[i]) * owed_[i];
        on_liquid_ +=
            points_.volume[i] * (step_ * (drag_of_solids_[i] - beta_[i] * velocity[i]) + owed_[i]);
    }
    return owed_;
}

Real Exchange::mismatch() const noexcept {
    return sizes_ > 0 ? norm(on_liquid_ + on_solids_) / sizes_ : 0;
}

} // namespace mpsdem::coupling
