#include "runtime/device/choose_device.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "runtime/device/match_device.hpp"
#include "schema/spelling.hpp"
#include "schema/without_place.hpp"

namespace wale {
namespace {

constexpr std::string_view simulated = "simulated", simulated_as = "simulated:";

bool is_usable(const PluggedIn& plugged) { return !plugged.can.empty() && !plugged.obstacle; }

/// Whether it is a force device, usable now or not: it can push, or its declaration says that it can.
bool is_force_device(const PluggedIn& plugged, const MatchedDevice& match) {
  return !plugged.can.empty() || (match.device != nullptr && !match.is_generic);
}

bool is_port(const std::string& text) {
  const auto dash = text.find('-');
  return dash != std::string::npos && dash > 0 && dash + 1 < text.size() &&
         text.find_first_not_of("0123456789.-") == std::string::npos;
}

struct Candidate {
  const PluggedIn* plugged;
  MatchedDevice match;
};

class Chooser {
 public:
  Chooser(const DeviceRequest& request, std::span<const DeclaredDevice> known, std::span<const TrustedDevice> trusted,
          std::span<const PluggedIn> plugged, Drivers drivers)
      : request_(request), known_(known), trusted_(trusted), drivers_(drivers) {
    for (const PluggedIn& each : plugged) all_.push_back({&each, match_device(each, trusted)});
    std::stable_sort(all_.begin(), all_.end(), [](const Candidate& a, const Candidate& b) {
      return a.match.is_generic < b.match.is_generic;  // declared figures are better than assumed ones
    });
  }

  Result<ChosenDevice> choose() const {
    const std::string& asked = request_.spelling;
    if (asked == simulated) return ChosenDevice{};
    if (asked.starts_with(simulated_as)) {
      const std::string name = asked.substr(simulated_as.size());
      if (const DeclaredDevice* device = declared(name)) return simulate(*device);
      return unknown(name, simulated_as);
    }
    if (request_.only_simulated) return only_simulated();
    if (asked == "auto") return best_or_simulated();
    const Driver* driver = driver_of(asked);
    if (driver != nullptr && !has_transport(*driver, request_.transport))
      return without_transport("`" + asked + "`", *driver);
    return named(asked);
  }

 private:
  /// The driver of a device that may not be plugged in. Null if that is not known before it is.
  const Driver* driver_of(const std::string& asked) const {
    if (const Driver* driver = find_driver(drivers_, asked)) return driver;
    std::vector<UsbNumbers> numbers;
    if (const auto read = read_usb_numbers(asked)) numbers = {*read};
    if (const TrustedDevice* device = trusted(asked)) numbers = device->wiring().usb;
    const auto drives_it = [&](const Driver* driver) {
      return driver->drives != nullptr && !numbers.empty() && std::ranges::all_of(numbers, driver->drives);
    };
    const auto found = std::ranges::find_if(drivers_, drives_it);
    return found != drivers_.end() ? *found : nullptr;
  }

  Error without_transport(const std::string& device, const Driver& driver) const {
    std::string ways;
    for (const std::string_view way : driver.transports) ways += (ways.empty() ? "" : ", ") + std::string(way);
    return {.code = Code::malformed_value,
            .sentence = device + " is not driven by `" + request_.transport + "`",
            .mend = ways.empty() ? "leave it out: there is only one way to drive it"
                                 : "leave it out, or choose among " + ways,
            .place = {.name = request_.by_call ? "transport" : "--transport", .text = request_.transport}};
  }

  /// To simulate. What the program knows goes before what only the owner declares.
  const DeclaredDevice* declared(const std::string& name) const {
    const auto found =
        std::ranges::find_if(known_, [&](const DeclaredDevice& each) { return each.profile.name == name; });
    if (found != known_.end()) return &*found;
    const TrustedDevice* own = trusted(name);
    return own != nullptr ? &own->declared() : nullptr;
  }

  const TrustedDevice* trusted(const std::string& name) const {
    const auto found =
        std::ranges::find_if(trusted_, [&](const TrustedDevice& each) { return each.profile().name == name; });
    return found != trusted_.end() ? &*found : nullptr;
  }

  bool fits(const Candidate& each) const {
    return request_.built_for.empty() || each.match.device->profile().name == request_.built_for;
  }

  Error error(Code code, std::string sentence, std::string mend) const {
    const char* asked_by = request_.by_call ? "spelling" : "--device";
    return {code, std::move(sentence), std::move(mend), {.name = asked_by, .text = request_.spelling}};
  }

  /// How to ask for a device.
  std::string asking_for(const std::string& device) const {
    return request_.by_call ? "`" + device + "`" : "`--device " + device + "`";
  }

  Error built_for_another(const std::string& profile) const {
    return error(Code::other_device, "the program is built for `" + request_.built_for + "`, not for `" + profile + "`",
                 "feel it on `" + request_.built_for + "`, or build it for `" + profile + "`");
  }

  Result<ChosenDevice> simulate(const DeclaredDevice& device) const {
    if (!request_.built_for.empty() && device.profile.name != request_.built_for)
      return built_for_another(device.profile.name);
    return ChosenDevice{.declared = device};
  }

  /// The choice with virtual time or a simulated hand, which no real device can have.
  Result<ChosenDevice> only_simulated() const {
    const std::string& asked = request_.spelling;
    if (asked == "auto") return ChosenDevice{};
    if (const DeclaredDevice* device = declared(asked)) {
      auto chosen = simulate(*device);
      if (chosen) chosen->said = "simulating `" + asked + "`: virtual time and --hand are for a simulation";
      return chosen;
    }
    if (asked != "usb" && find_driver(drivers_, asked) == nullptr && !read_usb_numbers(asked) && !is_port(asked))
      return unknown(asked, "");
    return error(Code::malformed_value, "a real device runs in real time, in a real hand",
                 "leave out --virtual-time and --hand, or choose a simulated device");
  }

  /// The device with these numbers, at this port, of this declaration or of this driver.
  Result<ChosenDevice> named(const std::string& asked) const {
    if (asked == "usb")
      return real(
          [](const Candidate& each) {
            return !each.plugged->numbers.empty() && is_force_device(*each.plugged, each.match);
          },
          "no force-feedback device is plugged in on USB");
    if (const auto numbers = read_usb_numbers(asked))
      return real([&](const Candidate& each) { return each.plugged->numbers == in_words(*numbers); },
                  "no device " + asked + " is plugged in");
    if (is_port(asked))
      return real([&](const Candidate& each) { return each.plugged->port == asked; },
                  "no device is plugged in at port " + asked);
    if (const TrustedDevice* device = trusted(asked)) return declared_and_real(device->declared());
    if (const DeclaredDevice* device = declared(asked)) return only_known(*device);
    if (find_driver(drivers_, asked) != nullptr)
      return real(
          [&](const Candidate& each) {
            return each.plugged->driver->name == asked && is_force_device(*each.plugged, each.match);
          },
          "no device of the driver " + asked + " is plugged in");
    return unknown(asked, "");
  }

  Result<ChosenDevice> declared_and_real(const DeclaredDevice& device) const {
    const std::string& name = device.profile.name;
    const auto is_it = [&](const Candidate& each) {
      return each.match.device != nullptr && each.match.device->profile().name == name &&
             is_force_device(*each.plugged, each.match);
    };
    if (std::ranges::none_of(all_, is_it)) {
      if (device.wiring.usb.empty() && !device.wiring.is_generic) return simulate(device);
      if (!request_.built_for.empty() && name != request_.built_for) return built_for_another(name);
    }
    return real(is_it, "no " + name + " is plugged in", std::string(simulated_as) + name);
  }

  /// A device that is known, but from nothing that is trusted: it can only be simulated.
  Result<ChosenDevice> only_known(const DeclaredDevice& device) const {
    const std::string& name = device.profile.name;
    const bool is_of_program = name == request_.only_in_program;
    if (!is_of_program && device.wiring.usb.empty() && !device.wiring.is_generic) return simulate(device);
    const std::string from = is_of_program
                                 ? "` is known only from the patch program, which does not say whether there is a real "
                                   "one"
                             : request_.by_call ? "` is declared by the application"
                                                : "` is declared by a material, its imports or its project";
    return error(Code::untrusted_device,
                 "`" + name + from + ", and only a declaration that you trust says what a newton is on a real device",
                 std::string("`wale devices --identify` writes one of your own; ") +
                     (request_.by_call ? "" : "`--devices FILE` trusts the declarations of a file; ") +
                     asking_for(std::string(simulated_as) + name) + " simulates it");
  }

  Error unknown(const std::string& name, std::string_view prefix) const {
    std::vector<std::string> names;
    for (const DeclaredDevice& each : known_) names.push_back(each.profile.name);
    for (const TrustedDevice& each : trusted_) names.push_back(each.profile().name);
    if (prefix.empty()) {
      for (const std::string_view word : words_for_devices) names.emplace_back(word);
      for (const Driver* driver : drivers_) names.emplace_back(driver->name);
    }
    const std::string wanted = std::string(prefix) + name;
    std::string mend;
    if (!prefix.empty() && (name.empty() || letters_changed(name, simulated) <= 2)) {
      mend = "`simulated` alone is the device that the program is built for";
    } else if (const auto near = nearest_spelling(name, names)) {  // the prefix would make all of them similar
      mend = "did you mean `" + std::string(prefix) + *near + "`?";
    } else {
      std::ranges::sort(names);
      names.erase(std::unique(names.begin(), names.end()), names.end());
      for (const std::string& each : names) mend += (mend.empty() ? "there are: " : ", ") + std::string(prefix) + each;
      if (prefix.empty()) mend += ", vendor and product as in 1209:ffb0, and ports as in 1-2";
    }
    Error unknown = error(Code::unknown_device, "there is no device `" + wanted + "`", mend);
    for (const std::string& near : nearest_spellings(name, names))
      unknown.nearest.push_back(std::string(prefix) + near);
    return unknown;
  }

  Result<ChosenDevice> taken(const Candidate& candidate) const {
    if (!has_transport(*candidate.plugged->driver, request_.transport))
      return without_transport("the " + in_words(*candidate.plugged), *candidate.plugged->driver);
    const TrustedDevice& trusted = *candidate.match.device;
    ChosenDevice chosen{.declared = trusted.declared(),
                        .plugged = *candidate.plugged,
                        .trusted = trusted,
                        .is_generic = candidate.match.is_generic,
                        .said = "using " + in_words(*candidate.plugged) + " as " + trusted.profile().name +
                                (trusted.file().empty() ? "" : ", as " + trusted.file() + " declares it"),
                        .is_worth_saying = true};
    if (chosen.is_generic)
      chosen.said += "\n  no declaration is about it, so its figures are assumed; `wale devices --identify " +
                     candidate.plugged->port + "` prints one to begin with";
    if (const DeclaredDevice* unused = untrusted_match(*candidate.plugged, known_, trusted_))
      chosen.said += "\n  `" + unused->profile.name +
                     "`, which the material or its project declares, is not used for it: only a declaration that you "
                     "trust\n  says what a newton is on a real device; `wale devices --identify " +
                     candidate.plugged->port + "` writes one, and --devices FILE trusts those of a file";
    for (const Candidate& other : all_)
      if (other.plugged != candidate.plugged && is_usable(*other.plugged) && other.match.device != nullptr)
        chosen.said += "\n  also plugged in: " + in_words(*other.plugged) + "; --device " + other.plugged->port;
    return chosen;
  }

  Error unusable(const PluggedIn& plugged) const {
    if (!plugged.obstacle)
      return error(Code::unusable_device, in_words(plugged) + " cannot be used: nothing says what it can do", "");
    return error(plugged.obstacle->code, in_words(plugged) + " cannot be used: " + plugged.obstacle->sentence,
                 plugged.obstacle->mend);
  }

  /// The best plugged device that `is_meant` accepts; never a simulated one. What is wrong with a plugged device is
  /// not wrong in the option's words, so such an error names no place.
  template <class IsMeant>
  Result<ChosenDevice> real(IsMeant is_meant, const std::string& none, const std::string& instead = "simulated") const {
    std::optional<Error> why;
    for (const Candidate& each : all_) {
      if (!is_meant(each)) continue;
      const std::string name = in_words(*each.plugged);
      if (!is_usable(*each.plugged)) {
        if (!why) why = unusable(*each.plugged);
      } else if (each.match.device == nullptr) {
        why = Error{Code::unknown_device, "no declaration is about " + name,
                    "declare it, as `wale devices --identify` prints it"};
      } else if (!fits(each)) {
        const std::string& profile = each.match.device->profile().name;
        why = Error{
            Code::other_device,
            "the program is built for `" + request_.built_for + "`, and " + name + " is used as `" + profile + "`",
            "build it for that (`wale build FILE --device " + profile + " -o OUT.wpp`), or simulate its own (" +
                asking_for(std::string(simulated)) + ")"};
      } else {
        return taken(each);
      }
    }
    if (why) return *std::move(why);
    return error(Code::absent_device, none, "plug it in, or use " + asking_for(instead));
  }

  Result<ChosenDevice> best_or_simulated() const {
    ChosenDevice chosen;
    for (const Candidate& each : all_) {
      if (!each.plugged->driver->is_chosen_by_auto || !is_force_device(*each.plugged, each.match)) continue;
      if (is_usable(*each.plugged) && each.match.device != nullptr && fits(each)) return taken(each);
      chosen.is_worth_saying = true;
      if (!is_usable(*each.plugged))
        chosen.said += in_words_without_place(unusable(*each.plugged)) + "\n";
      else if (each.match.device != nullptr)
        chosen.said += in_words(*each.plugged) + " is used as " + each.match.device->profile().name +
                       ", and the program is built for " + request_.built_for + "\n";
    }
    chosen.said += chosen.is_worth_saying ? "using a simulated device instead"
                                          : "no force-feedback device is plugged in; using a simulated one";
    return chosen;
  }

  const DeviceRequest& request_;
  std::span<const DeclaredDevice> known_;
  std::span<const TrustedDevice> trusted_;
  Drivers drivers_;
  std::vector<Candidate> all_;
};

}  // namespace

Result<ChosenDevice> choose_device(const DeviceRequest& request, std::span<const DeclaredDevice> known,
                                   std::span<const TrustedDevice> trusted, std::span<const PluggedIn> plugged,
                                   Drivers drivers) {
  return Chooser(request, known, trusted, plugged, drivers).choose();
}

}  // namespace wale
