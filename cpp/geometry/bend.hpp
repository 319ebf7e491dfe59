#pragma once

#include "core/check.hpp"
#include "core/lanes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mpsdem::geometry {

/// The axis of a bent pipe at a point along it, across the pipe (x = 0): w and its derivatives.
template <class T>
struct AxisPoint {
    Vector<T> displacement; // [m]    w
    Vector<T> slope;        // [-]    dw/dx
    Vector<T> velocity;     // [m/s]  dw/dt
    Vector<T> curvature;    // [1/m]  d2w/dx2
    Vector<T> turning;      // [1/s]  d2w/dxdt
};

/// Where the axis of a pipe along x is at one moment, displaced across the pipe by standing modes:
///
///   w(x, t) = sum_n a_n(t) cos(k_n x),   k_n = n pi / L
///
/// Each cross-section, a plane x = const., moves as one body: its circle stays a circle of the same
/// area, so the shear map (x, y, z) -> (x, y + w_y, z + w_z) keeps every volume.
class Bend {
public:
    struct Mode {
        Real wave_number; // [1/m] k_n; 0 moves the pipe as one body
        Vec3 amplitude;   // [m]   a_n, its x is 0
        Vec3 velocity;    // [m/s] of the amplitude
    };

    Bend() = default;
    explicit Bend(std::vector<Mode> modes) : modes_(std::move(modes)) {}

    [[nodiscard]] bool straight() const noexcept { return modes_.empty(); }
    /// T: Real, or Lanes.
    template <class T>
    [[nodiscard]] AxisPoint<T> at(T x) const noexcept {
        AxisPoint<T> axis;
        for (const Mode& mode : modes_) {
            T cosine, sine;
            if constexpr (std::is_same_v<T, Real>) {
                cosine = std::cos(mode.wave_number * x);
                sine = std::sin(mode.wave_number * x);
            } else {
                for (std::size_t k = 0; k < lane_count; ++k) {
                    cosine[k] = std::cos(mode.wave_number * x[k]);
                    sine[k] = std::sin(mode.wave_number * x[k]);
                }
            }
            const T turned = -mode.wave_number * sine;
            axis.displacement += times(cosine, mode.amplitude);
            axis.slope += times(turned, mode.amplitude);
            axis.velocity += times(cosine, mode.velocity);
            axis.curvature += times(-mode.wave_number * mode.wave_number * cosine, mode.amplitude);
            axis.turning += times(turned, mode.velocity);
        }
        return axis;
    }
    /// What neither speed nor slope exceeds anywhere [m/s], [-].
    [[nodiscard]] Real most_speed() const noexcept {
        Real sum = 0;
        for (const Mode& mode : modes_) sum += norm(mode.velocity);
        return sum;
    }
    [[nodiscard]] Real most_slope() const noexcept {
        Real sum = 0;
        for (const Mode& mode : modes_) sum += mode.wave_number * norm(mode.amplitude);
        return sum;
    }

private:
    template <class T>
    [[nodiscard]] static Vector<T> times(T factor, const Vec3& v) noexcept {
        return {T{}, factor * v.y, factor * v.z};
    }

    std::vector<Mode> modes_;
};

/// How a pipe bends over a step: the amplitude of each mode is the cubic in time through its ends,
/// displacement and velocity, so that the velocity is its derivative throughout.
class Bending {
public:
    struct Mode {
        Real wave_number;           // [1/m]
        Vec3 from, velocity_before; // [m], [m/s] at the start
        Vec3 to, velocity_after;    // at the end
    };

    Bending() = default;
    Bending(std::vector<Mode> modes, Real duration)
        : modes_(std::move(modes)), duration_(duration) {
        require(duration > 0 && std::isfinite(duration), "Bending: duration must be > 0 s");
        for (const Mode& mode : modes_) {
            require(mode.wave_number >= 0 && std::isfinite(mode.wave_number),
                    "Bending: wave_number must be >= 0 1/m and finite");
            for (const Vec3& v : {mode.from, mode.velocity_before, mode.to, mode.velocity_after}) {
                require(std::isfinite(norm(v)), "Bending: the modes must be finite");
                require(v.x == 0, "Bending: a pipe bends across itself: x must be 0");
            }
        }
    }

    [[nodiscard]] bool straight() const noexcept { return modes_.empty(); }
    [[nodiscard]] Real duration() const noexcept { return duration_; } // [s]
    /// The pipe so many seconds after the start of the step; as at its ends before and after it.
    [[nodiscard]] Bend at(Real elapsed) const {
        const Real s = std::clamp(elapsed / duration_, 0., 1.);
        const bool done = elapsed >= duration_ * (1 - 1e-9); // then to the last bit
        std::vector<Bend::Mode> modes;
        modes.reserve(modes_.size());
        for (const Mode& m : modes_) {
            if (done) {
                modes.push_back({m.wave_number, m.to, m.velocity_after});
                continue;
            }
            const Vec3 way = m.to - m.from;
            const Vec3 start = duration_ * m.velocity_before, end = duration_ * m.velocity_after;
            const Vec3 square = 3 * way - 2 * start - end, cube = start + end - 2 * way;
            modes.push_back({m.wave_number, m.from + s * (start + s * (square + s * cube)),
                             (1 / duration_) * (start + s * (2 * square + (3 * s) * cube))});
        }
        return Bend(std::move(modes));
    }

private:
    std::vector<Mode> modes_;
    Real duration_ = 1; // [s]
};

} // namespace mpsdem::geometry
