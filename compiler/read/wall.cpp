#include "compiler/read/wall.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <vector>

#include "compiler/measure/coarseness.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/still_forces.hpp"
#include "compiler/read/unlimited.hpp"
#include "compiler/text/readable.hpp"
#include "wale/batch.hpp"

namespace wale {
namespace {

constexpr int scan_lines = 5;             // in each of four directions
constexpr double step = 0.5e-3;           // m between the positions of a scan
constexpr int steps_free = 8;             // 4 mm without force before a face; no texture has so much
constexpr int steps_deep = 3;             // 1.5 mm over which the force must grow in proportion to depth
constexpr double least_push = 0.02;       // N at that depth
constexpr double proportional = 0.15;     // of the force: tolerance for a straight line
constexpr double gently = 0.03;           // of the largest push: what may be felt where a face begins
constexpr double slow = 0.02;             // m/s, the speed at which damping is measured
constexpr double nearly_straight = 0.02;  // of the largest push
constexpr double jump_of_rise = 3;        // times the usual rise from one step to the next
constexpr std::array<long, 2> waits = {97, 211};  // ticks: no swing is the same after both
constexpr double least_preload = 0.05, before_a_jump = 0.5;  // of the largest push, and of the preload

/// A line of hands at rest. If the program has memory, one hand goes along the line step by step instead.
struct Scan {
  glm::dvec2 from{0}, direction{0};
  std::size_t first = 0, count = 0;  // index of the first hand and their number

  Hand hand(double steps, glm::dvec2 velocity = {0, 0}) const {
    Hand hand;
    hand.position = hand.workspace = glm::vec2(from + steps * step * direction);
    hand.velocity = hand.raw_velocity = glm::vec2(velocity);
    return hand;
  }
};

std::vector<Scan> scans_of(PatchSize patch) {
  const glm::dvec2 half = 0.5 * glm::dvec2(patch.width, patch.height) - static_cast<double>(patch.rim);
  std::vector<Scan> scans;
  std::size_t first = 0;
  for (const glm::dvec2 direction : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)})
    for (int line = 0; line < scan_lines; ++line) {
      const glm::dvec2 across{std::abs(direction.y), std::abs(direction.x)};
      const double length = 2 * glm::dot(half, glm::abs(direction));
      scans.push_back({-half * direction + half * across * ((line + 0.5) / (0.5 * scan_lines) - 1), direction, first,
                       static_cast<std::size_t>(std::max(1.0, length / step))});
      first += scans.back().count;
    }
  return scans;
}

/// The forces along all lines, one after another. A program with memory is scanned by hands that move the whole way
/// slowly, after a wait of so many ticks where they come: a wall may yield to a hand that is placed behind its face.
std::vector<Force> forces_along(const Bank& bank, const std::vector<Scan>& scans, long waited = 0) {
  std::vector<Force> forces(scans.back().first + scans.back().count);
  if (!remembers_anything(bank.program().description())) {
    std::vector<Hand> hands;
    hands.reserve(forces.size());
    for (const Scan& scan : scans)
      for (std::size_t i = 0; i < scan.count; ++i) hands.push_back(scan.hand(static_cast<double>(i)));
    tick_coarsely(bank, hands, forces);
    return forces;
  }
  Batch batch(bank, scans.size());
  std::vector<Hand> hands(scans.size());
  std::vector<Force> felt(scans.size());
  const auto longest = static_cast<long>(std::ranges::max(scans, {}, &Scan::count).count);
  for (long now = 0; now < waited + longest; ++now) {
    const auto i = static_cast<std::size_t>(std::max(0L, now - waited));
    for (std::size_t k = 0; k < scans.size(); ++k) {
      hands[k] = scans[k].hand(static_cast<double>(std::min(i, scans[k].count - 1)));
      hands[k].time = static_cast<double>(now) / bank.program().description().device.rate;
    }
    if (now == 0) batch.enter(hands);
    batch.tick(hands, felt);
    for (std::size_t k = 0; k < scans.size(); ++k)
      if (i < scans[k].count) forces[scans[k].first + i] = felt[k];
  }
  return forces;
}

/// The forces on hands that moved along a line for so many steps and then have each of these velocities.
std::array<Force, 3> forces_at(const Bank& bank, const Scan& scan, double steps,
                               const std::array<glm::dvec2, 3>& velocities) {
  std::array<Force, 3> forces{};
  std::array<Hand, 3> hands{};
  Batch batch(bank, hands.size());
  hands.fill(scan.hand(0));
  batch.enter(hands);
  if (remembers_anything(bank.program().description()))
    for (double gone = 0; gone < steps; ++gone) {
      hands.fill(scan.hand(gone));
      batch.tick(hands, forces);
    }
  for (std::size_t i = 0; i < hands.size(); ++i) hands[i] = scan.hand(steps, velocities[i]);
  batch.tick(hands, forces);
  return forces;
}

/// A face, and the force on its flat side over the largest push behind it.
struct FaceFound {
  WallFace face;
  double outside = 0, most = 0;  ///< the latter is that push, N
};

/// The face of a feature whose profile is flat at its low or its high end.
std::optional<FaceFound> face_of(const Feature& feature, bool from_low) {
  const std::size_t count = feature.profile.size();
  const auto place = [&](std::size_t i) { return from_low ? i : count - 1 - i; };
  const glm::dvec2 inward = from_low ? feature.direction : -feature.direction;
  const glm::dvec2 flat = feature.profile[place(count / 40)];
  // Against a hand that goes in, N at each step from the flat end.
  std::vector<double> against;
  double most = 0, aside = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 push = feature.profile[place(i)] - flat;
    against.push_back(-glm::dot(push, inward));
    most = std::max(most, against.back());
    aside = std::max(aside, std::abs(push.x * inward.y - push.y * inward.x));
  }
  if (most < least_push || aside > 0.3 * most) return std::nullopt;
  // The first straight part, between a tenth and six tenths of the largest push.
  std::size_t first = 0;
  while (first < count && against[first] < 0.1 * most) ++first;
  std::size_t last = first;
  const auto go_on_to = [&](double part) {
    while (last + 1 < count && against[last + 1] < part * most && against[last + 1] >= against[last] - 0.03 * most)
      ++last;
  };
  go_on_to(0.6);
  // After a large jump the straight part lies higher.
  const bool high = last < first + 3;
  if (high) go_on_to(0.95);
  if (last < first + 3) return std::nullopt;
  // A jump is smeared over some steps, and what follows it is another line.
  const std::size_t began = first;
  const double usual_rise = (against[last] - against[first]) / static_cast<double>(last - first);
  while (first + 3 < last && against[first + 1] - against[first] > jump_of_rise * usual_rise) ++first;
  double n = 0, x = 0, f = 0, xx = 0, xf = 0;
  for (std::size_t i = first; i <= last; ++i) {
    const double at = feature.step * static_cast<double>(i);
    n += 1, x += at, f += against[i], xx += at * at, xf += at * against[i];
  }
  const double slope = (n * xf - x * f) / (n * xx - x * x), onset = x / n - f / n / slope;
  double off = 0;
  for (std::size_t i = first; i <= last; ++i)
    off = std::max(off, std::abs(against[i] - slope * (feature.step * static_cast<double>(i) - onset)));
  // A spring is as steep at the flat end; a bend is no face, nor is a push that grows with the square of the distance:
  // where the line through it begins it is a twentieth of its largest.
  if (!(slope > 0) || off > proportional * 0.6 * most || onset < steps_free * step) return std::nullopt;
  const auto at_onset = static_cast<std::size_t>(onset / feature.step);
  if (against[at_onset] > gently * most + slope * feature.step) return std::nullopt;
  const auto before = static_cast<std::size_t>(0.7 * onset / feature.step);
  for (std::size_t i = 0; i < before; ++i)
    if (std::abs(against[i]) > 0.1 * most) return std::nullopt;
  // Where the line has long been more than the profile is, the face begins with a jump, just before the straight part.
  const double jump_at = feature.step * (static_cast<double>(began) - 0.5), preload = slope * (jump_at - onset);
  const bool jumps = preload > least_preload * most && began > 2 && against[began - 2] < before_a_jump * preload;
  if (high && !jumps) return std::nullopt;
  const double begins = jumps ? jump_at : onset;
  const double along =
      from_low ? feature.low + begins : feature.low + feature.step * static_cast<double>(count - 1) - begins;
  return FaceFound{{along * feature.direction + 0.0, inward + 0.0, slope, 0, 0, jumps ? preload : 0},
                   glm::length(flat) / most,
                   most};
}

/// Finds the place of a jump as well as the numbers of the machine allow, and the line behind it by the forces there;
/// `most` (N) is the largest push.
void sharpen_jump(const Bank& bank, const Feature& feature, double most, WallFace& face) {
  constexpr int points = 32;
  const glm::dvec2 at = face.place;
  const auto against = [&](double along) {
    const glm::dvec2 place = at + along * face.inward;
    return -glm::dot(forces_at(bank, {&place, 1}).front(), face.inward);
  };
  double outside = -2 * feature.step, inside = 2 * feature.step;
  const double half = 0.5 * (against(outside) + against(inside));
  if (against(inside) - against(outside) < before_a_jump * face.preload) return;
  for (int turn = 0; turn < 20; ++turn) {
    const double middle = 0.5 * (outside + inside);
    (against(middle) < half ? outside : inside) = middle;
  }
  face.place = at + inside * face.inward, face.preload += face.stiffness * inside;
  const double depth = 0.5 * (most - face.preload) / face.stiffness;
  double x = 0, f = 0, xx = 0, xf = 0;
  std::array<glm::dvec2, points> line;
  for (int i = 0; i < points; ++i) {
    const double deep = depth * (i + 0.5) / points, push = against(inside + deep);
    line[static_cast<std::size_t>(i)] = {deep, push};
    x += deep / points, f += push / points, xx += deep * deep / points, xf += deep * push / points;
  }
  const double stiffness = (xf - x * f) / (xx - x * x);
  const double preload = f - stiffness * x;
  const bool straight = std::ranges::all_of(
      line, [&](glm::dvec2 each) { return std::abs(each.y - preload - stiffness * each.x) < nearly_straight * most; });
  if (!straight || !(stiffness > 0)) return;
  // Of a small jump before a steep line half of the force is not yet half of the jump.
  double before = inside - 2 * feature.step, behind = inside + 2 * feature.step;
  const double from = inside;
  for (int turn = 0; turn < 20; ++turn) {
    const double middle = 0.5 * (before + behind);
    (against(middle) < 0.5 * (preload + stiffness * (middle - from)) ? before : behind) = middle;
  }
  face.place = at + behind * face.inward;
  face.stiffness = stiffness, face.preload = preload + stiffness * (behind - from);
}

/// The forces against hands that rest, go in and go out at one place, so that only the speed makes a difference.
std::array<double, 3> against_at(const Bank& bank, glm::dvec2 place, glm::dvec2 inward) {
  std::array<Hand, 3> hands{};
  std::array<Force, 3> forces{};
  for (std::size_t i = 0; i < hands.size(); ++i) {
    const glm::dvec2 velocity = i == 0 ? glm::dvec2(0) : i == 1 ? slow * inward : -slow * inward;
    hands[i].position = hands[i].workspace = glm::vec2(place);
    hands[i].velocity = hands[i].raw_velocity = glm::vec2(velocity);
  }
  tick_coarsely(bank, hands, forces);
  std::array<double, 3> against{};
  for (std::size_t i = 0; i < forces.size(); ++i) against[i] = -glm::dot(glm::dvec2(forces[i]), inward);
  return against;
}

/// The damping of a face: what it adds to what drags the hand in front of it too.
void tell_damping(const Bank& bank, WallFace& face) {
  // Not so deep that a limit takes a part.
  const double most = std::min(limit_of(bank).least(), face.most);
  const double depth = std::clamp(0.3 * (most - face.preload) / face.stiffness, 1e-5, 2e-3);
  const auto inside = against_at(bank, face.place + depth * face.inward, face.inward);
  const auto outside = against_at(bank, face.place - 2e-3 * face.inward, face.inward);
  face.damping = ((inside[1] - inside[0]) - (outside[1] - outside[0])) / slow;
  face.release = ((inside[0] - inside[2]) - (outside[0] - outside[2])) / slow;
}

}  // namespace

std::optional<WallFace> wall_face(const Bank& bank) {
  const std::vector<Scan> scans = scans_of(bank.size());
  const std::vector<Force> forces = forces_along(bank, scans);
  // What swings or comes with time in a part of the patch begins there like a face. A wall is the same for a hand that
  // comes later.
  std::vector<std::vector<Force>> later;
  if (const PatchProgram& program = bank.program().description(); remembers_anything(program) && goes_by_time(program))
    for (const long waited : waits) later.push_back(forces_along(bank, scans, waited));
  const auto is_steady = [&](std::size_t first, double within) {
    return std::ranges::all_of(later, [&](const std::vector<Force>& other) {
      for (std::size_t i = first; i <= first + steps_deep; ++i)
        if (glm::length(other[i] - forces[i]) > within) return false;
      return true;
    });
  };
  std::optional<WallFace> stiffest;
  const Scan* met = nullptr;
  double depth_met = 0;  // steps from the start of the line
  for (const Scan& scan : scans) {
    // The size of a push that has a part against the scan: a face may be oblique.
    const auto against = [&](std::size_t i) {
      const glm::dvec2 force(forces[scan.first + i]);
      return glm::dot(force, scan.direction) < 0 ? glm::length(force) : 0.0;
    };
    std::size_t free = 0;
    for (std::size_t i = 0; i + steps_deep + 1 < scan.count; ++i) {
      const bool touched = glm::length(forces[scan.first + i]) > 1e-4f;
      if (touched && free >= steps_free) {
        // The two ends of a straight line give the depth at which the force began, at most a step earlier.
        const double near = against(i), far = against(i + steps_deep), slope = (far - near) / (steps_deep * step);
        const double middle = against(i + 1), expected = near + slope * step;
        const bool straight = std::abs(middle - expected) <= proportional * far;
        const double depth = slope > 0 ? near / slope : -1;
        const glm::dvec2 push(forces[scan.first + i + steps_deep]);
        const glm::dvec2 inward = far > 0 ? -push / glm::length(push) : scan.direction;
        // Along an oblique line the depth grows with the cosine of the angle.
        const double cosine = glm::dot(inward, scan.direction), stiffness = slope / cosine;
        if (far > least_push && straight && depth >= 0 && depth <= 1.05 * step && cosine > 0.3 &&
            is_steady(scan.first + i, proportional * far) && (!stiffest || stiffness > 1.001 * stiffest->stiffness)) {
          const double steps = static_cast<double>(i) - depth / step;
          stiffest = WallFace{scan.from + steps * step * scan.direction + 0.0, inward + 0.0, stiffness, 0, 0};
          met = &scan, depth_met = steps + 2;
        }
      }
      free = touched ? 0 : free + 1;
    }
  }
  if (!stiffest) return stiffest;
  const glm::dvec2 in = slow * stiffest->inward;
  const auto against = [&](double depth) {
    const auto felt = forces_at(bank, *met, depth, {glm::dvec2(0), in, -in});
    std::array<double, 3> found{};
    for (std::size_t i = 0; i < felt.size(); ++i) found[i] = -glm::dot(glm::dvec2(felt[i]), stiffest->inward);
    return found;
  };
  const auto inside = against(depth_met), outside = against(std::max(0.0, depth_met - 6));
  stiffest->damping = ((inside[1] - inside[0]) - (outside[1] - outside[0])) / slow;
  stiffest->release = ((inside[0] - inside[2]) - (outside[0] - outside[2])) / slow;
  return stiffest;
}

std::optional<WallFace> wall_face(const Bank& bank, const std::vector<Feature>& features) {
  std::optional<WallFace> stiffest;
  for (const Feature& each : features) {
    if (each.radial || !each.monotone) continue;
    // A wall that saturates is flat at both ends. The hand is outside where there is less force.
    auto found = face_of(each, true);
    const auto other = face_of(each, false);
    if (!found || (other && other->outside < found->outside)) found = other;
    if (!found || (stiffest && found->face.stiffness <= stiffest->stiffness)) continue;
    stiffest = found->face;
    if (stiffest->preload > 0) sharpen_jump(bank, each, found->most, *stiffest);
  }
  if (!stiffest) return stiffest;
  tell_damping(bank, *stiffest);
  return stiffest;
}

namespace {

/// Half the sides of the patch without its rim, m.
glm::dvec2 half_inside(const Bank& bank) {
  return 0.5 * glm::dvec2(bank.size().width, bank.size().height) - static_cast<double>(bank.size().rim);
}

/// A round wall, where a hand can go deepest into it along x or y.
WallFace round_face(const Bank& bank, const Wall& wall, double limit) {
  WallFace found{{}, {1, 0}, wall.stiffness, 0, 0, wall.preload, wall.offset, wall.centre + 0.0, wall.fills, limit};
  const glm::dvec2 half = half_inside(bank);
  double most = -HUGE_VAL;
  for (const glm::dvec2 way : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
    const glm::dvec2 place = wall.centre + wall.offset * way, room = half - glm::abs(place);
    const double deep = wall.fills ? std::min(room.x, room.y) : glm::dot(room, glm::abs(way));
    if (deep > most) most = deep, found.place = place + 0.0, found.inward = (wall.fills ? -1.0 : 1.0) * way + 0.0;
  }
  tell_damping(bank, found);
  return found;
}

}  // namespace

WallFace wall_face(const Bank& bank, const Wall& wall, double most) {
  if (wall.round()) return round_face(bank, wall, most);
  WallFace found{wall.offset * wall.inward + 0.0, wall.inward + 0.0, wall.stiffness, 0, 0, wall.preload};
  // The part of the face that is nearest to the middle may lie beyond the patch's edge: the damping is felt within.
  const glm::dvec2 half = half_inside(bank), along(-wall.inward.y, wall.inward.x);
  double best = HUGE_VAL;
  glm::dvec2 place = found.place;
  for (int i = -32; i <= 32; ++i) {
    const glm::dvec2 other = found.place + along * (glm::length(half) * i / 32);
    const glm::dvec2 beyond = glm::abs(other) / half;
    const double far = std::max(beyond.x, beyond.y);
    if (far < best) best = far, place = other;
  }
  if (best < 1) found.place = place;
  found.most = most, found.power = wall.power;
  tell_damping(bank, found);
  found.place = wall.offset * wall.inward + 0.0;
  return found;
}

WallDepth deepest(const Bank& bank, const WallFace& face) {
  const PatchSize size = bank.size();
  WallDepth reached{std::numeric_limits<double>::infinity(), 0};
  const double half[] = {size.width / 2, size.height / 2};
  for (const int axis : {0, 1})
    if (std::abs(face.inward[axis]) > 1e-6)
      reached.depth = std::min(reached.depth,
                               (std::copysign(half[axis], face.inward[axis]) - face.place[axis]) / face.inward[axis]);
  reached.depth = std::max(reached.depth, 0.0);
  if (face.radius > 0 && face.fills) reached.depth = std::min(reached.depth, face.radius);
  constexpr std::size_t steps = 64;
  std::array<Hand, steps> hands{};
  std::array<Force, steps> forces{};
  // Not quite to the edge, beyond which there is no force.
  for (std::size_t i = 0; i < steps; ++i)
    hands[i].position = hands[i].workspace =
        glm::vec2(face.place + face.inward * (reached.depth * 0.999 * static_cast<double>(i + 1) / steps));
  tick_coarsely(bank, hands, forces);
  const PatchProgram& program = bank.program().description();
  if (!program.states.empty() || !program.grids.empty()) {
    // A hand that is put inside the wall has not come in through its face, and the program may not resist it.
    reached.newton = std::min({face.stiffness * reached.depth, limit_of(bank).least(), face.most});
    return reached;
  }
  for (const Force& force : forces)
    reached.newton = std::max(reached.newton, -glm::dot(glm::dvec2(force), face.inward));
  // A texture that lies over a wall pushes beside the wall's own limit.
  if (face.most < HUGE_VAL)
    reached.newton = std::min({face.preload + face.stiffness * reached.depth, limit_of(bank).least(), face.most});
  return reached;
}

namespace {

/// Whether the work against a straight face is not given back farther in, as it is on the far side of a hill. `in` (N)
/// pushes into it outside.
bool holds_back_inside(const Bank& bank, const WallFace& face, double in) {
  if (face.radius > 0 || remembers_anything(bank.program().description())) return true;
  constexpr int places = 400;
  constexpr double given_back = 0.5;  // of the work
  const double depth = deepest(bank, face).depth;
  std::vector<Hand> hands(places);
  std::vector<Force> forces(places);
  for (int i = 0; i < places; ++i) {
    const glm::dvec2 place = face.place + depth * (i + 0.5) / places * face.inward;
    hands[static_cast<std::size_t>(i)].position = hands[static_cast<std::size_t>(i)].workspace = glm::vec2(place);
  }
  tick_coarsely(bank, hands, forces);
  double work = 0, most = 0;
  for (const Force& force : forces) {
    work += in - glm::dot(glm::dvec2(force), face.inward);
    most = std::max(most, work);
  }
  return work >= given_back * most;
}

}  // namespace

bool pushes_back(const Bank& bank, const WallFace& face) {
  constexpr double least_push = 0.02;        // N
  constexpr double plainly_more = 2.5;       // times what pushes in
  constexpr double near = 2e-3, far = 6e-3;  // m outside
  constexpr double aside = 5e-3;             // m along the face
  constexpr int places = 5;
  const double out = deepest(bank, face).newton;
  std::array<Hand, places * places> hands{};
  std::array<Force, places * places> forces{};
  const glm::dvec2 along(-face.inward.y, face.inward.x);
  for (int i = 0; i < places * places; ++i) {
    const double outside = near + (far - near) * (i % places) / (places - 1.0);
    const glm::dvec2 place = face.place - outside * face.inward + aside * (i / places - places / 2) * along;
    hands[static_cast<std::size_t>(i)].position = hands[static_cast<std::size_t>(i)].workspace = glm::vec2(place);
  }
  tick_coarsely(bank, hands, forces);
  double in = 0;
  for (const Force& force : forces) in += glm::dot(glm::dvec2(force), face.inward) / (places * places);
  return out >= least_push && out >= plainly_more * in && holds_back_inside(bank, face, in);
}

std::string wall_place(const WallFace& face) {
  constexpr double straight = 0.9999;  // cosine of less than a degree
  const auto in_mm = [](double metres) { return std::round(1e4 * metres) / 10 + 0.0; };
  if (face.radius > 0)
    return readable("{} {:g} mm {} ({:g}, {:g}) mm, all round", face.fills ? "within" : "beyond", in_mm(face.radius),
                    face.fills ? "of" : "from", in_mm(face.centre.x), in_mm(face.centre.y));
  if (std::abs(face.inward.x) > straight)
    return readable("{} of x = {:g} mm", face.inward.x > 0 ? "right" : "left", in_mm(face.place.x));
  if (std::abs(face.inward.y) > straight)
    return readable("{} y = {:g} mm", face.inward.y > 0 ? "above" : "below", in_mm(face.place.y));
  return readable("beyond ({:g}, {:g}) mm, towards {:.0f} degrees", in_mm(face.place.x), in_mm(face.place.y),
                  std::atan2(face.inward.y, face.inward.x) * 180 / std::numbers::pi);
}

}  // namespace wale
