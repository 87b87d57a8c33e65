#include "library/site/space.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>

#include "compiler/describe/describe_figure.hpp"
#include "compiler/drawing/canvas.hpp"
#include "compiler/drawing/style.hpp"
#include "compiler/text/json_text.hpp"
#include "library/site/material_page.hpp"
#include "library/site/page_data.hpp"
#include "runtime/machine/parallel.hpp"

namespace wale {
namespace {

constexpr std::size_t most_landmarks = 160;
constexpr std::size_t most_pairs = 20000;  // of the sample for the agreement
constexpr std::size_t fewest_levels = 12;  // materials that a percept's direction rests on
constexpr double telling_share = 0.25;     // of the variance, from which on a direction is shown

double difference(const Comparer& comparer, const SiteMaterial& a, const SiteMaterial& b) {
  return std::log2(1 + double{comparer.distance(*a.cues, *b.cues).noticeable});
}

/// Materials far from each other: each next one is the farthest from those before.
std::vector<std::size_t> landmarks_of(const FeltPlane& plane, const Comparer& comparer) {
  const std::size_t count = std::min(most_landmarks, plane.materials.size());
  std::vector<std::size_t> chosen = {0};
  std::vector<double> nearest(plane.materials.size(), std::numeric_limits<double>::infinity());
  while (chosen.size() < count) {
    const SiteMaterial& last = *plane.materials[chosen.back()];
    in_parallel(nearest.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        nearest[i] = std::min(nearest[i], difference(comparer, *plane.materials[i], last));
    });
    const auto farthest = std::ranges::max_element(nearest);
    if (*farthest <= 0) break;
    chosen.push_back(static_cast<std::size_t>(farthest - nearest.begin()));
  }
  return chosen;
}

std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    for (std::size_t i = begin; i < end; ++i) ranks[order[i]] = 0.5 * static_cast<double>(begin + end - 1);
    begin = end;
  }
  return ranks;
}

std::optional<double> correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double n = static_cast<double>(a.size());
  const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / n,
               mean_b = std::accumulate(b.begin(), b.end(), 0.0) / n;
  double both = 0, of_a = 0, of_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    both += (a[i] - mean_a) * (b[i] - mean_b);
    of_a += (a[i] - mean_a) * (a[i] - mean_a), of_b += (b[i] - mean_b) * (b[i] - mean_b);
  }
  return of_a > 0 && of_b > 0 ? std::optional(both / std::sqrt(of_a * of_b)) : std::nullopt;
}

std::optional<double> agreement_of(const FeltPlane& plane, const Comparer& comparer) {
  const std::size_t n = plane.materials.size();
  if (n < 3) return std::nullopt;
  const std::size_t all = n * (n - 1) / 2, step = std::max<std::size_t>(1, all / most_pairs);
  std::vector<double> felt, drawn;
  std::size_t number = 0;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a + 1; b < n; ++b, ++number) {
      if (number % step != 0) continue;
      felt.push_back(difference(comparer, *plane.materials[a], *plane.materials[b]));
      const glm::dvec2 apart = plane.places[a] - plane.places[b];
      drawn.push_back(std::hypot(apart.x, apart.y));
    }
  return correlation(ranks_of(felt), ranks_of(drawn));
}

/// By least squares of the level over the places of those that have one.
std::vector<FeltPlane::Axis> axes_of(const FeltPlane& plane) {
  std::map<std::string, std::vector<std::pair<std::size_t, double>>> levels;
  for (std::size_t i = 0; i < plane.materials.size(); ++i)
    for (const SitePercept& each : plane.materials[i]->percepts)
      if (each.reads) levels[each.name].emplace_back(i, *each.reads);
  std::vector<FeltPlane::Axis> axes;
  for (const auto& [percept, all] : levels) {
    if (all.size() < fewest_levels) continue;
    Eigen::MatrixXd places(all.size(), 3);
    Eigen::VectorXd values(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const glm::dvec2 place = plane.places[all[i].first];
      const auto row = static_cast<Eigen::Index>(i);
      places(row, 0) = place.x, places(row, 1) = place.y, places(row, 2) = 1, values(row) = all[i].second;
    }
    const Eigen::VectorXd fit = places.colPivHouseholderQr().solve(values);
    const double variance = (values.array() - values.mean()).square().sum();
    const double left = (values - places * fit).squaredNorm();
    const double length = std::hypot(fit(0), fit(1));
    if (variance <= 0 || length <= 0) continue;
    const double share = 1 - left / variance;
    if (share >= telling_share) axes.push_back({percept, {fit(0) / length, fit(1) / length}, share});
  }
  return axes;
}

/// The colour of the kind with that number: neighbours in number are far apart in hue.
Colour kind_colour(std::size_t number) {
  const double hue = std::fmod(0.58 + 0.618034 * static_cast<double>(number), 1.0);
  const double light = number % 2 == 0 ? 0.42 : 0.56;
  const auto part = [&](double shift) {
    const double at = std::fmod(hue + shift, 1.0) * 6;
    const double ramp = std::clamp(std::abs(at - 3) - 1, 0.0, 1.0);
    return static_cast<float>(light * (0.25 + 1.1 * ramp));
  };
  return {std::min(part(0), 1.0f), std::min(part(2.0 / 3), 1.0f), std::min(part(1.0 / 3), 1.0f)};
}

constexpr int plane_width = 880, plane_height = 620;

struct Drawn {
  std::vector<PagePoint> places;  ///< 0 .. 1 each way, y downwards
};

/// The places within the picture, with a margin.
Drawn drawn_places(const FeltPlane& plane) {
  glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
  for (const glm::dvec2 place : plane.places) low = glm::min(low, place), high = glm::max(high, place);
  const double aspect = double{plane_width} / plane_height;
  const double span = std::max({(high.x - low.x) / aspect, high.y - low.y, 1e-9}) * 1.16;
  const glm::dvec2 middle = 0.5 * (low + high);
  Drawn drawn;
  for (const glm::dvec2 place : plane.places)
    drawn.places.emplace_back(0.5 + (place.x - middle.x) / (span * aspect), 0.5 - (place.y - middle.y) / span);
  return drawn;
}

Result<std::string> picture_of(const FeltPlane& plane, const Drawn& drawn, const std::vector<std::size_t>& colour_of) {
  auto page = new_canvas(plane_width, plane_height, style::paper);
  if (!page) return page.error();
  Canvas& canvas = **page;
  for (const FeltPlane::Axis& axis : plane.axes) {
    const PagePoint middle(plane_width / 2.0, plane_height / 2.0), way(axis.way.x, -axis.way.y);
    const PagePoint end = middle + way * (0.44 * plane_height);
    canvas.line(middle, end, {1.2, style::rule});
    canvas.write(end + way * 8.0, axis.percept, {Face::sans, 15, style::quiet},
                 way.x > 0.3    ? Align::left
                 : way.x < -0.3 ? Align::right
                                : Align::centre);
  }
  for (std::size_t i = 0; i < drawn.places.size(); ++i) {
    std::vector<PagePoint> dot;
    for (int corner = 0; corner < 12; ++corner) {
      const double angle = corner * std::numbers::pi / 6;
      dot.emplace_back(drawn.places[i].x * plane_width + 3.4 * std::cos(angle),
                       drawn.places[i].y * plane_height + 3.4 * std::sin(angle));
    }
    canvas.area(dot, kind_colour(colour_of[i]), 0.75f);
  }
  const auto bytes = encode_drawing(canvas.pixels(), "space.png");
  if (!bytes) return bytes.error();
  return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
}

std::string css_colour(Colour colour) {
  const auto part = [](float value) { return static_cast<int>(std::lround(255 * value)); };
  return fmt::format("#{:02x}{:02x}{:02x}", part(colour.red), part(colour.green), part(colour.blue));
}

}  // namespace

FeltPlane felt_plane(const std::vector<const SiteMaterial*>& materials, const Comparer& comparer) {
  FeltPlane plane;
  for (const SiteMaterial* each : materials)
    if (each->cues) plane.materials.push_back(each);
  if (plane.materials.empty()) return plane;
  const std::vector<std::size_t> landmarks = landmarks_of(plane, comparer);
  const auto m = static_cast<Eigen::Index>(landmarks.size());
  const auto square = [&](std::size_t a, std::size_t b) {
    const double apart = difference(comparer, *plane.materials[a], *plane.materials[b]);
    return apart * apart;
  };
  Eigen::MatrixXd squares(m, m);
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index j = 0; j < m; ++j)
      squares(i, j) = square(landmarks[static_cast<std::size_t>(i)], landmarks[static_cast<std::size_t>(j)]);
  const Eigen::VectorXd means = squares.rowwise().mean();
  const double mean = means.mean();
  Eigen::MatrixXd centred = -0.5 * ((squares.colwise() - means).rowwise() - means.transpose());
  centred.array() -= 0.5 * mean;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(centred);
  Eigen::MatrixXd onto = Eigen::MatrixXd::Zero(2, m);  // of the differences from the landmarks onto the plane
  for (Eigen::Index axis = 0; axis < std::min<Eigen::Index>(2, m); ++axis) {
    const Eigen::Index at = m - 1 - axis;  // the eigenvalues rise
    const double size = parts.eigenvalues()(at);
    if (size <= 1e-12) continue;
    Eigen::VectorXd way = parts.eigenvectors().col(at);
    Eigen::Index largest = 0;
    way.cwiseAbs().maxCoeff(&largest);
    if (way(largest) < 0) way = -way;  // one sign on every machine
    onto.row(axis) = way.transpose() / std::sqrt(size);
  }
  plane.places.resize(plane.materials.size());
  in_parallel(plane.materials.size(), [&](std::size_t begin, std::size_t end) {
    Eigen::VectorXd from(m);
    for (std::size_t i = begin; i < end; ++i) {
      for (Eigen::Index j = 0; j < m; ++j) from(j) = means(j) - square(i, landmarks[static_cast<std::size_t>(j)]);
      const Eigen::Vector2d place = 0.5 * onto * from;
      plane.places[i] = {place(0), place(1)};
    }
  });
  plane.agreement = agreement_of(plane, comparer);
  plane.axes = axes_of(plane);
  return plane;
}

Result<std::vector<SiteFile>> space_files(const FeltPlane& plane, const std::vector<const SiteMaterial*>& listed) {
  std::map<std::string, std::size_t> kinds;
  for (const SiteMaterial* each : plane.materials) kinds.try_emplace(each->folder, 0);
  std::size_t next = 0;
  for (auto& [kind, number] : kinds) number = next++;
  std::vector<std::size_t> colour_of;
  for (const SiteMaterial* each : plane.materials) colour_of.push_back(kinds[each->folder]);
  const Drawn drawn = drawn_places(plane);
  auto picture = picture_of(plane, drawn, colour_of);
  if (!picture) return picture.error();
  std::vector<SiteFile> files;
  files.push_back({"figure/-space.png", *std::move(picture)});

  std::map<const SiteMaterial*, std::size_t> numbers;
  for (std::size_t i = 0; i < listed.size(); ++i) numbers[listed[i]] = i;
  using Json = nlohmann::ordered_json;
  Json data = {{"at", Json::array()}, {"x", Json::array()}, {"y", Json::array()}, {"kind", colour_of}};
  const auto coordinate = [](double part) { return std::lround(1e4 * part); };
  for (std::size_t i = 0; i < plane.materials.size(); ++i) {
    data["at"].push_back(numbers[plane.materials[i]]);
    data["x"].push_back(coordinate(drawn.places[i].x)), data["y"].push_back(coordinate(drawn.places[i].y));
  }
  for (std::size_t i = 0; i < kinds.size(); ++i) data["shades"].push_back(css_colour(kind_colour(i)));
  files.push_back({"data/space.js", "wale.take(\"space\"," + script_json(json_text(data)) + ");\n"});

  SitePage page{.path = "space.html",
                .title = "Percept space",
                .description = "Materials on a plane by how they differ to the hand",
                .section = "space.html"};
  page.scripts = {"site.js", "data/search.js", "space.js"};
  Markup legend, axes;
  for (const auto& [kind, number] : kinds)
    legend += html(
        "<li><svg viewBox=\"0 0 10 10\" class=\"dot\" aria-hidden=\"true\"><circle cx=\"5\" cy=\"5\" r=\"4\" "
        "fill=\"{}\"/></svg> {}</li>",
        css_colour(kind_colour(number)), kind.empty() ? "without a kind" : kind);
  for (const FeltPlane::Axis& axis : plane.axes)
    axes += html("<li>{}: its direction explains {} % of its differences</li>", axis.percept,
                 std::lround(100 * axis.share));
  page.body = html(
      "<h1>Percept space</h1>\n<p>Each dot is a material; {} lie here. Dots that are near each other feel alike. The "
      "difference is that of the cue which differs most, in just noticeable differences, on a logarithmic scale. A "
      "plane "
      "cannot keep all of it{}.</p>\n"
      "<figure class=\"space\"><div class=\"plane\" data-plane=\"data/space.js\"><img src=\"figure/-space.png\" "
      "width=\"{}\" height=\"{}\" alt=\"Dots, one for each material\"></div>\n"
      "<figcaption id=\"dot\" role=\"status\">With scripts, point at a dot, or choose the picture and use the arrow "
      "keys; "
      "Enter opens the material.</figcaption></figure>\n<ul class=\"legend\">{}</ul>\n",
      plane.materials.size(),
      plane.agreement ? fmt::format(": the order of the distances agrees with that of the differences by {} "
                                    "(rank correlation)",
                                    with_decimals(*plane.agreement, 2))
                      : std::string(),
      plane_width, plane_height, legend);
  if (!axes.empty())
    page.body += html("<h2>Directions</h2>\n<p>The lines point to where a percept grows.</p>\n<ul>{}</ul>\n", axes);
  ListedPages all;
  for (const SiteMaterial* each : plane.materials) all.emplace_back(each->shown(), "material/" + each->page + ".html");
  page.data = list_data(page, all);
  files.push_back({page.path, framed(page)});
  files.push_back({data_path(page), page.data});
  return files;
}

}  // namespace wale
