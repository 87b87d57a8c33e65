#include "library/open_device.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "compiler/text/spelling.hpp"
#include "runtime/stage/scheduling.hpp"

namespace wale {
namespace {

constexpr std::string_view simulated = "simulated";

bool is_usable(const PluggedIn& plugged) { return !plugged.can.empty() && plugged.obstacle.empty(); }

/// Something to feel on that is not, or may be: it can push, or its declaration says that its like can.
bool should_be_usable(const PluggedIn& plugged, const MatchedProfile& match) {
  return !plugged.can.empty() || (match.device != nullptr && !match.is_generic);
}

bool is_port(const std::string& text) {
  const auto dash = text.find('-');
  return dash != std::string::npos && dash > 0 && dash + 1 < text.size() &&
         text.find_first_not_of("0123456789.-") == std::string::npos;
}

using Choice = std::variant<ChosenDevice, Absent, Refusal>;

struct Candidate {
  const PluggedIn* plugged;
  MatchedProfile match;
};

class Chooser {
 public:
  Chooser(const DeviceRequest& request, const std::vector<DeclaredDevice>& known,
          const std::vector<PluggedIn>& plugged)
      : request_(request), known_(known) {
    for (const PluggedIn& each : plugged) all_.push_back({&each, matched_profile(each, known)});
    std::stable_sort(all_.begin(), all_.end(), [](const Candidate& a, const Candidate& b) {
      return a.match.is_generic < b.match.is_generic;  // what is known goes before what is assumed
    });
  }

  Choice choose() const {
    const std::string& asked = request_.spelling;
    if (asked == simulated) return ChosenDevice{};
    if (asked.starts_with("simulated:")) {
      const std::string name = asked.substr(std::string_view("simulated:").size());
      if (declared(name)) return simulated_as(name);
      return unknown(name, "simulated:");
    }
    if (request_.only_simulated) return as_simulated();
    if (asked == "auto") return best_or_simulated();
    if (asked == "usb")
      return real(
          [](const Candidate& each) {
            return !each.plugged->numbers.empty() && should_be_usable(*each.plugged, each.match);
          },
          "no force device on USB is plugged in");
    if (read_usb_numbers(asked))
      return real([&](const Candidate& each) { return each.plugged->numbers == in_words(*read_usb_numbers(asked)); },
                  fmt::format("no device {} is plugged in", asked));
    if (is_port(asked))
      return real([&](const Candidate& each) { return each.plugged->port == asked; },
                  fmt::format("nothing is plugged in at port {} that could be felt on", asked));
    if (declared(asked)) {
      const auto is_it = [&](const Candidate& each) {
        return each.match.device != nullptr && each.match.device->profile.name == asked &&
               should_be_usable(*each.plugged, each.match);
      };
      const DeviceWiring& wiring = declared(asked)->wiring;
      const bool is_there = std::ranges::any_of(all_, is_it);
      if (!is_there && wiring.usb.empty() && !wiring.is_generic) return simulated_as(asked);
      if (!is_there && !request_.built_for.empty() && asked != request_.built_for) return other_than_built_for(asked);
      return real(is_it, fmt::format("no {} is plugged in", asked), "simulated:" + asked);
    }
    if (device_kind(asked) != nullptr)
      return real(
          [&](const Candidate& each) {
            return each.plugged->kind == asked && should_be_usable(*each.plugged, each.match);
          },
          fmt::format("no device of the kind {} is plugged in", asked));
    return unknown(asked, "");
  }

 private:
  const DeclaredDevice* declared(const std::string& name) const {
    const auto found =
        std::ranges::find_if(known_, [&](const DeclaredDevice& each) { return each.profile.name == name; });
    return found != known_.end() ? &*found : nullptr;
  }

  bool fits(const Candidate& each) const {
    return request_.built_for.empty() || each.match.device->profile.name == request_.built_for;
  }

  Refusal other_than_built_for(const std::string& profile) const {
    return {fmt::format("the program is built for `{0}`, not for `{1}`: feel it there, or build it for `{1}`",
                        request_.built_for, profile),
            {}};
  }

  Choice simulated_as(const std::string& profile) const {
    if (!request_.built_for.empty() && profile != request_.built_for) return other_than_built_for(profile);
    ChosenDevice chosen;
    chosen.profile = profile;
    return chosen;
  }

  /// What is asked for, where no real device will do.
  Choice as_simulated() const {
    const std::string& asked = request_.spelling;
    if (asked == "auto") return ChosenDevice{};
    if (declared(asked)) return simulated_as(asked);
    if (asked != "usb" && device_kind(asked) == nullptr && !read_usb_numbers(asked) && !is_port(asked))
      return unknown(asked, "");
    return Refusal{"a real device runs in real time, in a real hand: leave out --virtual-time and --hand", {}};
  }

  Refusal unknown(const std::string& name, const std::string& prefix) const {
    std::vector<std::string> names;
    for (const DeclaredDevice& each : known_) names.push_back(prefix + each.profile.name);
    if (prefix.empty()) {
      for (const char* word : {"auto", "simulated", "usb"}) names.emplace_back(word);
      for (const DeviceKind& kind : device_kinds()) names.emplace_back(kind.name);
    }
    const auto near = nearest_spelling(prefix + name, names);
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return {fmt::format(
                "there is no device `{}{}`; {}", prefix, name,
                near ? fmt::format("did you mean `{}`?", *near)
                     : fmt::format("there are: {}{}", fmt::join(names, ", "),
                                   prefix.empty() ? ", vendor and product as in 1209:ffb0, and ports as in 1-2" : "")),
            {}};
  }

  ChosenDevice taken(const Candidate& candidate) const {
    ChosenDevice chosen;
    chosen.profile = candidate.match.device->profile.name;
    chosen.plugged = *candidate.plugged;
    chosen.wiring = candidate.match.device->wiring;
    chosen.is_generic = candidate.match.is_generic;
    chosen.is_worth_saying = true;
    chosen.said = fmt::format("feeling on {}, as {}", in_words(*candidate.plugged), chosen.profile);
    if (chosen.is_generic)
      chosen.said += fmt::format(
          ": no declaration is about it, so its figures are assumed; `wale devices --identify {}` prints one "
          "to begin with",
          candidate.plugged->port);
    for (const Candidate& other : all_)
      if (other.plugged != candidate.plugged && is_usable(*other.plugged) && other.match.device != nullptr)
        chosen.said += fmt::format("\n  also there: {}; --device {}", in_words(*other.plugged), other.plugged->port);
    return chosen;
  }

  /// What is there of a sort, and nothing simulated.
  template <class IsMeant>
  Choice real(IsMeant is_meant, const std::string& nothing, const std::string& instead = "simulated") const {
    std::optional<Refusal> refusal;
    for (const Candidate& each : all_) {
      if (!is_meant(each)) continue;
      if (!is_usable(*each.plugged)) {
        if (!refusal)
          refusal = {fmt::format("{} cannot be used: {}", in_words(*each.plugged), each.plugged->obstacle), {}};
      } else if (each.match.device == nullptr) {
        refusal = {fmt::format("{} is no device that anything declares", in_words(*each.plugged)), {}};
      } else if (!fits(each)) {
        refusal = {
            fmt::format("the program is built for `{}`, and {} is taken for `{}`: build it for that "
                        "(`wale build FILE --device {} -o OUT.wpp`), or feel it simulated (`--device simulated`)",
                        request_.built_for, in_words(*each.plugged), each.match.device->profile.name,
                        each.match.device->profile.name),
            {}};
      } else {
        return taken(each);
      }
    }
    if (refusal) return *refusal;
    return Absent{nothing, fmt::format("`--device {}`", instead)};
  }

  Choice best_or_simulated() const {
    ChosenDevice chosen;
    for (const Candidate& each : all_) {
      const DeviceKind* kind = device_kind(each.plugged->kind);
      if (kind == nullptr || !kind->is_chosen_by_auto || !should_be_usable(*each.plugged, each.match)) continue;
      if (is_usable(*each.plugged) && each.match.device != nullptr && fits(each)) return taken(each);
      chosen.is_worth_saying = true;
      if (!is_usable(*each.plugged))
        chosen.said += fmt::format("{} cannot be used: {}\n", in_words(*each.plugged), each.plugged->obstacle);
      else if (each.match.device != nullptr)
        chosen.said += fmt::format("{} is taken for {}, and the program is built for {}\n", in_words(*each.plugged),
                                   each.match.device->profile.name, request_.built_for);
    }
    chosen.said += chosen.is_worth_saying ? "so it is felt on a simulated device"
                                          : "no force-feedback device is plugged in: simulated";
    return chosen;
  }

  const DeviceRequest& request_;
  const std::vector<DeclaredDevice>& known_;
  std::vector<Candidate> all_;
};

/// What is plugged in and like something that was. On USB nothing is opened to find out: another one may be in use.
std::vector<PluggedIn> alike(const Connections& connections, const DeviceKind& kind, const PluggedIn& plugged) {
  const auto numbers = read_usb_numbers(plugged.numbers);
  if (!numbers || !connections.usb) return kind.find(connections, &plugged);
  std::vector<PluggedIn> all;
  for (const UsbDeviceInfo& info : connections.usb->devices()) {
    if (*numbers != UsbNumbers{info.vendor, info.product}) continue;
    all.push_back(plugged);
    all.back().port = info.port;
    all.back().usb = info;
  }
  return all;
}

}  // namespace

MatchedProfile matched_profile(const PluggedIn& plugged, const std::vector<DeclaredDevice>& known) {
  const auto numbers = read_usb_numbers(plugged.numbers);
  const DeclaredDevice* generic = nullptr;
  for (const DeclaredDevice& device : known) {
    if (!plugged.profile.empty() && device.profile.name == plugged.profile) return {&device, false};
    if (numbers && std::ranges::find(device.wiring.usb, *numbers) != device.wiring.usb.end()) return {&device, false};
    if (device.wiring.is_generic && generic == nullptr) generic = &device;
  }
  if (!plugged.profile.empty() || !numbers) return {};
  return {generic, generic != nullptr};
}

std::vector<PluggedIn> plugged_in(const Connections& connections, std::string_view asked) {
  std::vector<PluggedIn> all;
  for (const DeviceKind& kind : device_kinds()) {
    if (!kind.is_chosen_by_auto && kind.name != asked) continue;
    for (PluggedIn& each : kind.find(connections, nullptr)) all.push_back(std::move(each));
  }
  return all;
}

std::variant<ChosenDevice, Absent, Refusal> choose_device(const DeviceRequest& request,
                                                          const std::vector<DeclaredDevice>& known,
                                                          const std::vector<PluggedIn>& plugged) {
  return Chooser(request, known, plugged).choose();
}

std::variant<std::unique_ptr<HotPluggedDevice>, Refusal> open_device(const Connections& connections,
                                                                     const ChosenDevice& chosen,
                                                                     const DeviceProfile& profile,
                                                                     std::function<void(const std::string&)> ask,
                                                                     const std::atomic<bool>* stop) {
  const PluggedIn& plugged = *chosen.plugged;
  const DeviceKind& kind = *device_kind(plugged.kind);
  const DeviceOptions options{.priority = loop_priority - 1, .ask = std::move(ask), .stop = stop};
  if (connections.usb) connections.usb->set_priority(options.priority);  // not permitted: as punctual as may be
  std::set<std::string> others;                                          // where another of its like was
  for (const PluggedIn& each : alike(connections, kind, plugged))
    if (each.port != plugged.port) others.insert(each.port);
  OpenedDevice opened = kind.open(connections, plugged, profile, options);
  if (auto* refusal = std::get_if<Refusal>(&opened)) return std::move(*refusal);

  const auto reopen = [connections, plugged, profile, options, others, &kind]() -> OpenedDevice {
    const std::vector<PluggedIn> found = alike(connections, kind, plugged);
    const PluggedIn* again = nullptr;
    for (const PluggedIn& each : found)
      if (each.port == plugged.port || (again == nullptr && !others.contains(each.port))) again = &each;
    if (again == nullptr) return Refusal{"it is not plugged in", {}};
    return kind.open(connections, *again, profile, options);
  };
  return std::make_unique<HotPluggedDevice>(std::move(std::get<std::unique_ptr<PluggedDevice>>(opened)), chosen.wiring,
                                            reopen);
}

}  // namespace wale
