#pragma once

#include "core/vec3.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mpsdem::mps::lagrangian {

/// Means over equal bins along the pipe, and the broken line through them. Around a periodic pipe
/// the line closes; else it is level beyond the middles of the first and the last bin.
class AxialBins {
public:
    /// Bins of about `width` [m] from `low` to `high` [m].
    AxialBins(Real low, Real high, Real width, bool periodic)
        : low_(low), periodic_(periodic),
          sum_(static_cast<std::size_t>(std::max(1., std::round((high - low) / width))), 0),
          count_(sum_.size(), 0), width_((high - low) / static_cast<Real>(sum_.size())) {}

    void add(Real x, Real value) noexcept {
        const auto b = static_cast<std::size_t>(
            std::clamp((x - low_) / width_, 0., static_cast<Real>(sum_.size() - 1)));
        sum_[b] += value;
        count_[b] += 1;
    }
    /// Close the sums; `at` gives their means from now on. An empty bin's is 0.
    void take_means() noexcept {
        for (std::size_t b = 0; b < sum_.size(); ++b) sum_[b] /= std::max(count_[b], 1.);
    }
    /// The broken line through the means.
    [[nodiscard]] Real at(Real x) const noexcept {
        const auto bins = static_cast<Real>(sum_.size());
        Real place = (x - low_) / width_ - 0.5;
        if (!periodic_) place = std::clamp(place, 0., bins - 1);
        const Real below = std::floor(place);
        const Real share = place - below;
        const auto b = static_cast<std::size_t>(below + bins) % sum_.size();
        return (1 - share) * sum_[b] + share * sum_[(b + 1) % sum_.size()];
    }

private:
    Real low_; // [m]
    bool periodic_;
    std::vector<Real> sum_, count_;
    Real width_; // [m]
};

} // namespace mpsdem::mps::lagrangian
