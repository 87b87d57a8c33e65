#pragma once

#include <string>
#include <vector>

#include "compiler/command/command.hpp"
#include "compiler/command/verb.hpp"

/// Options that several verbs take. Each is written to what it is given once the command line is read, so that must
/// live as long as the verb.
namespace wale::command {

/// --library DIR, which may be repeated.
void offer_library(CLI::App& verb, std::vector<std::string>& folders);

/// --device NAME, or the same under another name.
void offer_device(CLI::App& verb, std::string& device, const char* option = "--device");

/// FILE, --material NAME, --device NAME and --library DIR: what names one material.
void offer_material(CLI::App& verb, Choice& choice, const char* device_option = "--device");

/// --set NAME=VALUE, which may be repeated.
void offer_settings(CLI::App& verb, std::vector<std::string>& settings);

/// --json; `about` says what the output is then.
void offer_json(CLI::App& verb, bool& json, const char* about);

/// -o, --output FILE.
void offer_output(CLI::App& verb, std::string& out, const char* about);

}  // namespace wale::command
