#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace wale {

/// How far each square of a plane, row by row, is from the nearest with another number, centre to centre, squared, in
/// squares. What lies around the plane has another number than any. `Id` is std::uint8_t or int.
template <class Id>
std::vector<double> squared_edge_distances(std::span<const Id> numbers, std::size_t width, std::size_t height);

}  // namespace wale
