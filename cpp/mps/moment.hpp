#pragma once

#include "core/lanes.hpp"

namespace mpsdem::mps {

/// The symmetric matrix M = sum_j W r r^T / r^2 of a neighborhood. M^-1 corrects a first-order
/// operator, so that it is exact for linear fields wherever the neighbors are.
/// Source: Khayyer & Gotoh (2011), doi:10.1016/j.jcp.2011.01.009.
/// T is Real, or Lanes for one sum in each lane.
template <class T>
struct Moment {
    T xx{}, yy{}, zz{}, xy{}, xz{}, yz{};

    void add(T factor, const Vector<T>& r) noexcept { add(factor * r, r); }
    /// The same with `weighted`, the factor times r, at hand.
    void add(const Vector<T>& weighted, const Vector<T>& r) noexcept {
        xx += weighted.x * r.x;
        yy += weighted.y * r.y;
        zz += weighted.z * r.z;
        xy += weighted.x * r.y;
        xz += weighted.x * r.z;
        yz += weighted.y * r.z;
    }
    [[nodiscard]] Real determinant() const noexcept {
        return xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    }
    /// Whether the neighbors lie, to round-off's reach, in a plane or are fewer than three: then a
    /// direction is missing and there is no inverse. 1 is a full neighborhood.
    [[nodiscard]] bool flat() const noexcept {
        const Real mean = (xx + yy + zz) / 3;
        return !(determinant() > flat_limit * mean * mean * mean);
    }
    /// M^-1 b; only where not flat.
    [[nodiscard]] Vec3 solve(const Vec3& b) const noexcept {
        const Real scale = 1 / determinant();
        return {scale * ((yy * zz - yz * yz) * b.x + (xz * yz - xy * zz) * b.y +
                         (xy * yz - xz * yy) * b.z),
                scale * ((xz * yz - xy * zz) * b.x + (xx * zz - xz * xz) * b.y +
                         (xy * xz - xx * yz) * b.z),
                scale * ((xy * yz - xz * yy) * b.x + (xy * xz - xx * yz) * b.y +
                         (xx * yy - xy * xy) * b.z)};
    }

private:
    static constexpr Real flat_limit = 1e-4; // [-] determinant over that of a full neighborhood
};

/// Of all lanes.
[[nodiscard]] inline Moment<Real> sum(const Moment<Lanes>& m) noexcept {
    using mpsdem::sum;
    return {sum(m.xx), sum(m.yy), sum(m.zz), sum(m.xy), sum(m.xz), sum(m.yz)};
}

} // namespace mpsdem::mps
