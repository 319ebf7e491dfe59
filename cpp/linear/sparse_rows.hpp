#pragma once

#include "core/parallel.hpp"
#include "core/vec3.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace mpsdem::linear {

/// A sparse matrix by rows, the entries of a row in any order.
template <class Value>
struct SparseRows {
    std::vector<Index> start{0}; // (rows + 1,)
    std::vector<Index> column;
    std::vector<Value> value;

    [[nodiscard]] std::size_t size() const noexcept { return start.size() - 1; }
};

/// A sparse row while it is summed up.
class SparseSum {
public:
    explicit SparseSum(std::size_t columns) : slot_(columns), met_(columns) {}

    /// Add entry(k), a column and a value, for k in [first, last).
    template <class Entry>
    void add(std::size_t first, std::size_t last, const Entry& entry) {
        Slot* const slots = slot_.data(); // no member is touched in the loop, which is long
        Index* const met = met_.data();
        const Index row = row_;
        std::size_t count = count_;
        for (std::size_t k = first; k < last; ++k) {
            const auto [column, value] = entry(k);
            Slot& slot = slots[column];
            if (slot.row != row) {
                slot = {0, row};
                met[count++] = column;
            }
            slot.value += value;
        }
        count_ = count;
    }

    /// Set one value so that the row sums to `total`.
    void balance(Index column, Real total) {
        add(0, 1, [&](std::size_t) { return std::pair(column, Real{0}); });
        for (std::size_t k = 0; k < count_; ++k) {
            if (met_[k] != column) total -= slot_[met_[k]].value;
        }
        slot_[column].value = total;
    }

    /// Append what was summed to a matrix, and begin the next row.
    template <class Value>
    void finish(SparseRows<Value>& rows) {
        for (std::size_t k = 0; k < count_; ++k) {
            rows.column.push_back(met_[k]);
            rows.value.push_back(static_cast<Value>(slot_[met_[k]].value));
        }
        rows.start.push_back(static_cast<Index>(rows.column.size()));
        count_ = 0;
        ++row_;
    }

private:
    struct Slot {
        Real value = 0;
        Index row = 0; // in which the column was last met
    };

    std::vector<Slot> slot_;
    std::vector<Index> met_; // the first count_ are columns of this row
    std::size_t count_ = 0;
    Index row_ = 1;
};

/// The matrix whose row c is what fill(c, sum) adds to a SparseSum.
template <class Value, class Fill>
[[nodiscard]] SparseRows<Value> sum_rows(std::size_t rows, std::size_t columns, int threads,
                                         const Fill& fill) {
    const auto parts = static_cast<std::size_t>(std::max(threads, 1));
    std::vector<SparseRows<Value>> part(parts);
    parallel_for_blocks(parts, threads, [&](std::size_t p) {
        SparseSum sum(columns);
        for (std::size_t c = rows * p / parts; c < rows * (p + 1) / parts; ++c) {
            fill(static_cast<Index>(c), sum);
            sum.finish(part[p]);
        }
    });
    SparseRows<Value> all = std::move(part.front());
    for (std::size_t p = 1; p < parts; ++p) {
        const auto shift = static_cast<Index>(all.column.size());
        for (std::size_t c = 1; c < part[p].start.size(); ++c) {
            all.start.push_back(part[p].start[c] + shift);
        }
        all.column.insert(all.column.end(), part[p].column.begin(), part[p].column.end());
        all.value.insert(all.value.end(), part[p].value.begin(), part[p].value.end());
    }
    return all;
}

/// Its transpose; the entries of a row stand in ascending order.
template <class Value>
[[nodiscard]] SparseRows<Value> transposed(const SparseRows<Value>& rows, std::size_t columns) {
    SparseRows<Value> all;
    all.start.assign(columns + 1, 0);
    for (const Index c : rows.column) ++all.start[c + 1];
    for (std::size_t c = 0; c < columns; ++c) all.start[c + 1] += all.start[c];
    all.column.resize(rows.column.size());
    all.value.resize(rows.value.size());
    std::vector<Index> next(all.start.begin(), all.start.end() - 1);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (std::size_t k = rows.start[i]; k < rows.start[i + 1]; ++k) {
            const Index place = next[rows.column[k]]++;
            all.column[place] = static_cast<Index>(i);
            all.value[place] = rows.value[k];
        }
    }
    return all;
}

} // namespace mpsdem::linear
