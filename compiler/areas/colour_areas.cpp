#include "compiler/areas/colour_areas.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace wale {
namespace {

using Colour = std::array<double, 3>;

/// How far from an edge, in pixels, its mixtures and a compression's traces of it reach: compressed pictures share the
/// colour of two by two pixels, and of blocks of eight.
constexpr int edge_reach = 4;
/// Pixels around an edge may be further from a colour than others, as a multiple of the tolerance.
constexpr double at_edges = 2;
/// Of the 255 steps of alpha: below it a pixel is transparent.
constexpr std::uint32_t half_opaque = 128;

Colour colour_of(std::uint32_t rgb) {
  return {static_cast<double>(rgb >> 16 & 255), static_cast<double>(rgb >> 8 & 255), static_cast<double>(rgb & 255)};
}

/// As a share of the distance of black and white.
double distance_of(const Colour& a, const Colour& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / 3) / 255;
}

/// The distance of a colour from the mixtures of three others, of which two may be equal.
double distance_from_mixture(const Colour& colour, const Colour& a, const Colour& b, const Colour& c) {
  const auto along = [](const Colour& from, const Colour& to, const Colour& other_from, const Colour& other_to) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += (to[i] - from[i]) * (other_to[i] - other_from[i]);
    return sum;
  };
  const auto mixed = [&](double of_b, double of_c) {
    Colour mixture{};
    for (std::size_t i = 0; i < 3; ++i) mixture[i] = a[i] + of_b * (b[i] - a[i]) + of_c * (c[i] - a[i]);
    return distance_of(colour, mixture);
  };
  const double bb = along(a, b, a, b), cc = along(a, c, a, c), bc = along(a, b, a, c);
  const double pb = along(a, colour, a, b), pc = along(a, colour, a, c), whole = bb * cc - bc * bc;
  // Inside of the triangle, or else on one of its sides.
  if (whole > 1e-9 * bb * cc) {
    const double of_b = (pb * cc - pc * bc) / whole, of_c = (pc * bb - pb * bc) / whole;
    if (of_b >= 0 && of_c >= 0 && of_b + of_c <= 1) return mixed(of_b, of_c);
  }
  const auto share = [](double part, double all) { return all > 0 ? std::clamp(part / all, 0.0, 1.0) : 0.0; };
  const double of_b = share(pb, bb), of_c = share(pc, cc), to_c = share(along(b, colour, b, c), along(b, c, b, c));
  return std::min({mixed(of_b, 0), mixed(0, of_c), mixed(1 - to_c, to_c)});
}

bool is_transparent(std::uint32_t pixel) { return pixel >> 24 < half_opaque; }

class Matcher {
 public:
  Matcher(const ColourImage& picture, const std::vector<std::uint32_t>& colours, double tolerance)
      : picture_(picture),
        width_(static_cast<int>(picture.width)),
        height_(static_cast<int>(picture.height)),
        tolerance_(tolerance) {
    for (const std::uint32_t each : colours) colours_.push_back(colour_of(each));
  }

  ColourAreas match() {
    nearest_.resize(picture_.pixels.size());
    for (std::size_t i = 0; i < nearest_.size(); ++i) nearest_[i] = nearest(picture_.pixels[i]);
    find_cores();
    ColourAreas found{picture_.width, picture_.height, nearest_, std::vector<std::size_t>(colours_.size(), 0), {}};
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x)
        if (const std::size_t i = index(x, y); core_[i] == nobody) found.areas[i] = of_edge(x, y);
    absorb_specks(found.areas);
    for (const AreaId each : found.areas)
      if (each != nobody) ++found.pixels[each];
    found.unmatched = unmatched(found.areas);
    return found;
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  /// The nearest colour within the tolerance. Pictures have far fewer colours than pixels, and each is looked up once.
  AreaId nearest(std::uint32_t pixel) {
    if (is_transparent(pixel)) return nobody;
    AreaId& known = known_[pixel & 0xffffff];
    if (known != unknown) return known;
    known = nobody;
    double least = tolerance_;
    for (std::size_t i = 0; i < colours_.size(); ++i)
      if (const double far = distance_of(colour_of(pixel), colours_[i]);
          far < least || (far == least && known == nobody))
        least = far, known = static_cast<AreaId>(i);
    return known;
  }

  /// A core is a pixel whose neighbours all have its colour: no edge is there.
  void find_cores() {
    core_.assign(nearest_.size(), nobody);
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        const AreaId own = nearest_[index(x, y)];
        if (own == nobody) continue;
        bool alone = true;
        for (int row = std::max(0, y - 1); row <= std::min(height_ - 1, y + 1) && alone; ++row)
          for (int column = std::max(0, x - 1); column <= std::min(width_ - 1, x + 1) && alone; ++column)
            alone = nearest_[index(column, row)] == own;
        if (alone) core_[index(x, y)] = own;
      }
  }

  /// Whether a pixel or one beside it is a core of a colour.
  bool touches_core(int x, int y, AreaId colour) const {
    for (int row = std::max(0, y - 1); row <= std::min(height_ - 1, y + 1); ++row)
      for (int column = std::max(0, x - 1); column <= std::min(width_ - 1, x + 1); ++column)
        if (core_[index(column, row)] == colour) return true;
    return false;
  }

  /// The colour of a pixel that is no core, by the cores around it.
  AreaId of_edge(int x, int y) const {
    const std::uint32_t pixel = picture_.pixels[index(x, y)];
    if (is_transparent(pixel)) return nobody;
    const AreaId own = nearest_[index(x, y)];
    if (own != nobody && touches_core(x, y, own)) return own;
    std::array<bool, most_colours> is_near{};
    std::array<AreaId, most_colours> near{};
    std::size_t near_count = 0;
    for (int row = std::max(0, y - edge_reach); row <= std::min(height_ - 1, y + edge_reach); ++row)
      for (int column = std::max(0, x - edge_reach); column <= std::min(width_ - 1, x + edge_reach); ++column)
        if (const AreaId there = core_[index(column, row)]; there != nobody && there != own && !is_near[there])
          is_near[there] = true, near[near_count++] = there;
    const Colour colour = colour_of(pixel);
    AreaId best = nobody;
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < near_count; ++i) {
      const Colour& side = colours_[near[i]];
      const double far = distance_of(colour, side);
      bool is_traced = own == nobody && far <= at_edges * tolerance_;
      // A mixture of two sides, or of three where they meet.
      for (std::size_t j = 0; j < near_count && !is_traced; ++j)
        for (std::size_t k = 0; k <= j && !is_traced; ++k)
          is_traced = j != i && k != i &&
                      distance_from_mixture(colour, side, colours_[near[j]], colours_[near[k]]) <= tolerance_;
      if (is_traced && far < least) least = far, best = near[i];
    }
    return best == nobody ? own : best;
  }

  /// Where several edges meet in a point, up to four pixels may be a mixture of more colours than are near. Such a
  /// speck goes to the colours around it, unless it has the very colour that it is taken for.
  void absorb_specks(std::vector<AreaId>& areas) const {
    constexpr std::size_t largest = 4;  // pixels
    std::vector<bool> seen(areas.size());
    const std::vector<AreaId> before = areas;
    for (std::size_t first = 0; first < areas.size(); ++first) {
      if (seen[first] || core_[first] != nobody) continue;
      std::vector<std::size_t> speck = {first};
      seen[first] = true;
      for (std::size_t i = 0; i < speck.size(); ++i)
        each_neighbour(speck[i], [&](std::size_t to) {
          if (before[to] == before[first] && !seen[to]) seen[to] = true, speck.push_back(to);
        });
      if (speck.size() > largest ||
          !std::ranges::all_of(speck, [&](std::size_t each) { return is_mixed(each, before); }))
        continue;
      for (const std::size_t each : speck) {
        double least = HUGE_VAL;
        each_neighbour(each, [&](std::size_t to) {
          if (before[to] == before[first] || before[to] == nobody) return;
          const double far = distance_of(colour_of(picture_.pixels[each]), colours_[before[to]]);
          if (far < least) least = far, areas[each] = before[to];
        });
      }
    }
  }

  /// Whether a pixel has none of the colours, or not the very one that it is taken for.
  bool is_mixed(std::size_t pixel, const std::vector<AreaId>& areas) const {
    constexpr double very_near = 0.2;  // of the tolerance
    if (areas[pixel] == nobody) return !is_transparent(picture_.pixels[pixel]);
    return distance_of(colour_of(picture_.pixels[pixel]), colours_[areas[pixel]]) > very_near * tolerance_;
  }

  template <class Visit>
  void each_neighbour(std::size_t from, const Visit& visit) const {
    const int x = static_cast<int>(from % picture_.width), y = static_cast<int>(from / picture_.width);
    for (int row = std::max(0, y - 1); row <= std::min(height_ - 1, y + 1); ++row)
      for (int column = std::max(0, x - 1); column <= std::min(width_ - 1, x + 1); ++column)
        if (row != y || column != x) visit(index(column, row));
  }

  UnmatchedColours unmatched(const std::vector<AreaId>& areas) const {
    struct Alike {
      std::size_t pixels = 0, first = 0;
      std::array<std::size_t, 3> sum{};
    };
    constexpr int kept_bits = 4;  // of each channel: colours that share them are much alike
    std::unordered_map<std::uint32_t, Alike> all;
    UnmatchedColours result;
    for (std::size_t i = 0; i < areas.size(); ++i) {
      const std::uint32_t pixel = picture_.pixels[i];
      if (areas[i] != nobody || is_transparent(pixel)) continue;
      ++result.pixels;
      const std::array<std::uint32_t, 3> parts = {pixel >> 16 & 255, pixel >> 8 & 255, pixel & 255};
      std::uint32_t key = 0;
      for (const std::uint32_t part : parts) key = key << kept_bits | part >> (8 - kept_bits);
      Alike& alike = all[key];
      if (alike.pixels++ == 0) alike.first = i;
      for (std::size_t part = 0; part < 3; ++part) alike.sum[part] += parts[part];
    }
    const Alike* most = nullptr;
    for (const auto& [key, each] : all)
      if (!most || each.pixels > most->pixels || (each.pixels == most->pixels && each.first < most->first))
        most = &each;
    if (!most) return result;
    for (const std::size_t sum : most->sum)
      result.mostly = result.mostly << 8 | static_cast<std::uint32_t>((sum + most->pixels / 2) / most->pixels);
    result.place = {static_cast<std::uint32_t>(most->first % picture_.width),
                    static_cast<std::uint32_t>(most->first / picture_.width)};
    return result;
  }

  const ColourImage& picture_;
  int width_, height_;
  double tolerance_;
  std::vector<Colour> colours_;
  static constexpr AreaId unknown = nobody - 1;
  std::vector<AreaId> known_ = std::vector<AreaId>(1 << 24, unknown);  ///< of each red, green and blue
  std::vector<AreaId> nearest_, core_;
};

}  // namespace

double colour_distance(std::uint32_t a, std::uint32_t b) { return distance_of(colour_of(a), colour_of(b)); }

ColourAreas colour_areas(const ColourImage& picture, const std::vector<std::uint32_t>& colours, double tolerance) {
  return Matcher(picture, colours, tolerance).match();
}

}  // namespace wale
