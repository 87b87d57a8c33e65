#include "calibration/command/trusted_here.hpp"

#include <CLI/CLI.hpp>
#include <cstdlib>

#include "compiler/command/command.hpp"
#include "compiler/command/print.hpp"
#include "compiler/modules/owners_devices_file.hpp"
#include "schema/visible_text.hpp"

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

void warn_of_owners_file(const TrustedDeclarations& trusted) {
  print_error("wale: warning: nothing in {} is used: {}\n", visible_text(owners_file()),
              error_text(*trusted.owners_problem));
}

Result<TrustedDeclarations> trusted_here(const std::vector<std::string>& files) {
  return trusted_declarations(files, owners_file());
}

}  // namespace wale::command
