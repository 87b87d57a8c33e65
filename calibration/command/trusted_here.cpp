#include "calibration/command/trusted_here.hpp"

#include <CLI/CLI.hpp>
#include <cstdlib>

#include "compiler/command/command.hpp"
#include "schema/owners_devices_file.hpp"

namespace wale::command {

void offer_trusted_files(CLI::App& verb, std::vector<std::string>& files) {
  verb.add_option("--devices", files,
                  "a Wale file whose exported devices may scale a real device, like those of "
                  "~/.config/wale/devices.wale; may be repeated")
      ->type_name("FILE")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
}

std::string owners_file() { return owners_devices_file(std::getenv("XDG_CONFIG_HOME"), std::getenv("HOME")); }

void warn_of_unused(const TrustedDeclarations& trusted) {
  if (trusted.owners_problem) warn_of_owners_file(owners_file(), *trusted.owners_problem);
  for (const Error& hidden : hidden_devices(trusted.checked)) warn(hidden);
}

Result<TrustedDeclarations> trusted_here(const std::vector<std::string>& files) {
  return trusted_declarations(files, owners_file());
}

}  // namespace wale::command
