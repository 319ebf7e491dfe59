#pragma once

#include <stdexcept>
#include <string>

namespace mpsdem {

/// Refuse bad input at the boundary: becomes a ValueError in Python. Never used inside a loop.
inline void require(bool holds, const std::string& message) {
    if (!holds) throw std::invalid_argument(message);
}

} // namespace mpsdem
