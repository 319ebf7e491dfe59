#include "core/check.hpp"
#include "mps/eulerian/liquid.hpp"

#include <algorithm>
#include <cmath>

/// What a liquid on nodes is told and asked between its steps.
namespace mpsdem::mps::eulerian {

namespace {

std::vector<Real> packed(const Field& rows) {
    std::vector<Real> out;
    out.reserve(rows.rows() * rows.stations());
    for (std::size_t i = 0; i < rows.rows(); ++i)
        out.insert(out.end(), rows[i], rows[i] + rows.stations());
    return out;
}

void unpack(std::span<const Real> values, Field& rows) {
    for (std::size_t i = 0; i < rows.rows(); ++i)
        std::copy_n(values.data() + i * rows.stations(), rows.stations(), rows[i]);
    rows.wrap();
}

} // namespace

void Liquid::momentum_source(std::span<const Vec3> acceleration) {
    if (acceleration.empty()) {
        source_ = VectorField();
        return;
    }
    require(acceleration.size() == size(),
            "momentum_source: one acceleration per node and station is needed");
    if (source_.x.rows() == 0) source_ = VectorField(section_.size(), stations());
    for (std::size_t i = 0; i < section_.size(); ++i) {
        for (std::size_t k = 0; k < stations(); ++k) {
            const Vec3& a = acceleration[i * stations() + k];
            source_.x[i][k] = a.x;
            source_.y[i][k] = a.y;
            source_.z[i][k] = a.z;
        }
    }
}

std::vector<Real> Liquid::pressure() const {
    std::vector<Real> out(size());
    Real mean = 0, weights = 0;
    for (std::size_t i = 0; i < section_.size(); ++i) {
        for (std::size_t k = 0; k < stations(); ++k) {
            out[i * stations() + k] =
                loaded_ ? density_ * loaded_->pressure[i][k] : pressure_scale_ * phi_[i][k];
            mean += section_.area(i) * out[i * stations() + k];
            weights += section_.area(i);
        }
    }
    for (Real& p : out) p -= mean / weights;
    return out;
}

std::vector<Real> Liquid::viscosity() const {
    return packed(nu_t_);
}

/// Volume flow of the first nodes over the stations' number [m3/s].
Real Liquid::flux(const Field& velocity, std::size_t nodes) const {
    Real sum = 0;
    for (std::size_t i = 0; i < nodes; ++i)
        sum += section_.area(i) * mean({velocity[i], stations()});
    return sum;
}

Real Liquid::bulk_velocity() const {
    return loaded_ ? mixture_flux(*loaded_).velocity : flux(u_.x, section_.size()) / bore_area_;
}

Real Liquid::mean_interior_velocity() const {
    return flux(u_.x, section_.interior_count()) / interior_area_;
}

/// What the source adds to the velocity of the inner nodes along the pipe [m/s2].
Real Liquid::source_velocity_rate() const {
    if (source_.x.rows() == 0) return 0;
    return flux(source_.x, section_.interior_count()) / interior_area_;
}

Real Liquid::wall_shear() const {
    const Real perimeter = section_.wall_share() * static_cast<Real>(section_.wall_count());
    return -density_ * mean(drag_) / perimeter;
}

Real Liquid::kinetic_energy() const {
    Real sum = 0, mass = 0;
    for (std::size_t i = 0; i < section_.size(); ++i) {
        Real row = 0, share = 0;
        for (std::size_t k = 0; k < stations(); ++k) {
            const Vec3 u{u_.x[i][k], u_.y[i][k], u_.z[i][k]};
            const Real eps = loaded_ ? loaded_->eps[i][k] : 1;
            row += eps * dot(u, u) / 2;
            share += eps;
        }
        sum += section_.area(i) * row;
        mass += section_.area(i) * share;
    }
    return sum / mass;
}

Real Liquid::pressure_noise() const {
    const std::vector<Real> p = pressure();
    Real sum = 0;
    for (std::size_t i = 0; i < section_.size(); ++i)
        for (std::size_t k = 0; k < stations(); ++k)
            sum += section_.area(i) * p[i * stations() + k] * p[i * stations() + k];
    return std::sqrt(sum / (bore_area_ * static_cast<Real>(stations())));
}

Liquid::Snapshot Liquid::snapshot() const {
    Snapshot out{{}, packed(phi_), packed(friction_velocity_), drag_, gradient_, {}};
    if (loaded_) out.loaded = loaded_->packed();
    for (Real& p : out.pressure) p *= pressure_scale_;
    out.velocity.reserve(size());
    for (std::size_t i = 0; i < section_.size(); ++i)
        for (std::size_t k = 0; k < stations(); ++k)
            out.velocity.push_back({u_.x[i][k], u_.y[i][k], u_.z[i][k]});
    return out;
}

void Liquid::restore(const Snapshot& s) {
    require(s.velocity.size() == size() && s.pressure.size() == size() &&
                s.friction_velocity.size() == section_.wall_count() * stations() &&
                s.drag.size() == stations(),
            "restore: the snapshot belongs to another liquid");
    loaded_.reset();
    if (!s.loaded.empty()) {
        loaded_.emplace(section_.size(), stations());
        loaded_->unpack(s.loaded);
    }
    for (std::size_t i = 0; i < section_.size(); ++i) {
        for (std::size_t k = 0; k < stations(); ++k) {
            const Vec3& v = s.velocity[i * stations() + k];
            u_.x[i][k] = v.x;
            u_.y[i][k] = v.y;
            u_.z[i][k] = v.z;
        }
    }
    u_.x.wrap();
    u_.y.wrap();
    u_.z.wrap();
    unpack(s.pressure, phi_);
    unpack(s.friction_velocity, friction_velocity_);
    pressure_scale_ = 1;
    drag_ = s.drag;
    gradient_ = s.gradient;
}

} // namespace mpsdem::mps::eulerian
