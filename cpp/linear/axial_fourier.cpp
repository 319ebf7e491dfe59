#include "linear/axial_fourier.hpp"

#include "core/parallel.hpp"

#include <complex>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace mpsdem::linear {

namespace {

using Complex = std::complex<Real>;
using Transform = Eigen::FFT<Real>;

constexpr std::size_t most_groups = 32; // rows share a plan and its buffers within a group

} // namespace

struct AxialFourier::Plans {
    std::vector<Transform> of_group;

    [[nodiscard]] std::size_t begin(std::size_t group, std::size_t count) const {
        return count * group / of_group.size();
    }
};

AxialFourier::AxialFourier(std::size_t rows, std::size_t stations)
    : stations_(stations), columns_((stations + 2 + lane_count - 1) / lane_count * lane_count),
      plans_(std::make_unique<Plans>()) {
    Transform plain;
    plain.SetFlag(Transform::HalfSpectrum);
    plain.SetFlag(Transform::Unscaled);
    plans_->of_group.assign(std::min(rows, most_groups), plain);
}

AxialFourier::AxialFourier(AxialFourier&&) noexcept = default;
AxialFourier& AxialFourier::operator=(AxialFourier&&) noexcept = default;
AxialFourier::~AxialFourier() = default;

void AxialFourier::forward(const Field& values, std::span<const Index> row, int threads,
                           std::span<Real> spectra) const {
    parallel_for(plans_->of_group.size(), threads, [&](std::size_t g) {
        for (std::size_t i = plans_->begin(g, row.size()); i < plans_->begin(g + 1, row.size());
             ++i) {
            // std::complex is two Reals in a row by the standard
            auto* to = reinterpret_cast<Complex*>(spectra.data() + row[i] * columns_);
            plans_->of_group[g].fwd(to, values[i], static_cast<Eigen::Index>(stations_));
        }
    });
}

void AxialFourier::inverse(std::span<const Real> spectra, std::span<const Index> row, int threads,
                           Field& values) const {
    parallel_for(plans_->of_group.size(), threads, [&](std::size_t g) {
        for (std::size_t i = plans_->begin(g, row.size()); i < plans_->begin(g + 1, row.size());
             ++i) {
            const auto* from = reinterpret_cast<const Complex*>(spectra.data() + row[i] * columns_);
            plans_->of_group[g].inv(values[i], from, static_cast<Eigen::Index>(stations_));
            values.wrap(i, 0, stations_);
        }
    });
}

} // namespace mpsdem::linear
