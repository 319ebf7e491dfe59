#pragma once

#include "core/field.hpp"
#include "core/vec3.hpp"

#include <memory>
#include <span>

namespace mpsdem::linear {

/// Discrete Fourier transform of every row of `Field` along its stations. Spectra are rows of
/// `columns()` numbers: real and imaginary part of the waves 0 to stations / 2, then zeros.
/// The transform is Eigen's (kissfft); nothing is scaled: there and back multiplies by stations.
class AxialFourier {
public:
    AxialFourier(std::size_t rows, std::size_t stations);
    AxialFourier(AxialFourier&&) noexcept;
    AxialFourier& operator=(AxialFourier&&) noexcept;
    ~AxialFourier();

    [[nodiscard]] std::size_t columns() const noexcept { return columns_; }

    /// Of the nodes [0, row.size()); the spectrum of node i is row[i] of the spectra.
    void forward(const Field& values, std::span<const Index> row, int threads,
                 std::span<Real> spectra) const;
    void inverse(std::span<const Real> spectra, std::span<const Index> row, int threads,
                 Field& values) const;

private:
    struct Plans;
    std::size_t stations_, columns_;
    std::unique_ptr<Plans> plans_;
};

} // namespace mpsdem::linear
