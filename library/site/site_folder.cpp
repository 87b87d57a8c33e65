#include "library/site/site_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "schema/fnv1a.hpp"

namespace wale {
namespace {

namespace fs = std::filesystem;

/// The folder's list of the files of the site, one path a line, and what the last build noted.
constexpr const char* list_name = ".wale-site-files";
constexpr const char* notes_name = ".wale-site-notes";
constexpr std::size_t longest_name = 120;

bool is_plain(char each) {
  return (each >= 'a' && each <= 'z') || (each >= 'A' && each <= 'Z') || (each >= '0' && each <= '9') || each == '_' ||
         each == '.';
}

char lower(char each) { return each >= 'A' && each <= 'Z' ? static_cast<char>(each - 'A' + 'a') : each; }

/// Whether Windows takes it for a device, whatever its ending: "con", "aux.html", "com1".
bool names_a_device(std::string_view name) {
  std::string first(name.substr(0, name.find('.')));
  std::ranges::transform(first, first.begin(), lower);
  static constexpr std::array<std::string_view, 4> alone = {"con", "prn", "aux", "nul"};
  const bool counted =
      first.size() == 4 && first[3] >= '0' && first[3] <= '9' && (first.starts_with("com") || first.starts_with("lpt"));
  return counted || std::ranges::find(alone, first) != alone.end();
}

std::string whole_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (in) text << in.rdbuf();
  return std::move(text).str();
}

Error unwritable(const std::string& path, std::string sentence, std::string mend = {}) {
  return Error{
      .code = Code::unwritable_file, .sentence = std::move(sentence), .mend = std::move(mend), .place = {.name = path}};
}

/// Writes a file beside its place and then puts it there. There is no wait for the disk: after a crash of the system
/// the next build compares all bytes again.
bool write_whole(const fs::path& path, std::string_view bytes) {
  std::error_code trouble;
  fs::create_directories(path.parent_path(), trouble);
  fs::path beside = path;
  beside += ".part";
  {
    std::ofstream out(beside, std::ios::binary | std::ios::trunc);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) {
      fs::remove(beside, trouble);
      return false;
    }
  }
  fs::rename(beside, path, trouble);
  return !trouble;
}

}  // namespace

std::string page_name(std::string_view text) {
  std::string name;
  for (const char each : text) {
    const bool hides = name.empty() && each == '.';
    if (is_plain(each) && !hides)
      name += each;
    else
      name += fmt::format("-{:02x}", static_cast<unsigned char>(each));
  }
  if (name.empty()) name = "-";
  if (name.back() == '.') name.back() = '-', name += "2e";
  if (names_a_device(name)) name = fmt::format("-{:02x}{}", static_cast<unsigned char>(name[0]), name.substr(1));
  if (name.size() <= longest_name) return name;
  Fnv1a<std::uint64_t> hash;
  for (const char each : text) hash.take(static_cast<std::uint8_t>(each));
  return fmt::format("{}--{:016x}", name.substr(0, longest_name - 18), hash.hash());
}

bool is_site_path(std::string_view path) {
  if (path.empty() || path.size() > 400) return false;
  for (;;) {
    const std::size_t end = path.find('/');
    const std::string_view part = path.substr(0, end);
    const bool plain = std::ranges::all_of(part, [](char each) { return is_plain(each) || each == '-'; });
    if (part.empty() || part.front() == '.' || !plain) return false;
    if (end == std::string_view::npos) return true;
    path.remove_prefix(end + 1);
  }
}

std::set<std::string> site_files(const std::string& folder) {
  std::set<std::string> files;
  std::ifstream in(fs::path(folder) / list_name);
  for (std::string line; std::getline(in, line);)
    if (is_site_path(line)) files.insert(line);
  return files;
}

Result<SiteFolder> SiteFolder::open(const std::string& folder) {
  std::error_code trouble;
  if (fs::exists(folder, trouble) && !fs::is_directory(folder, trouble))
    return unwritable(folder, "this is no folder", "name a new folder for the site");
  fs::create_directories(folder, trouble);
  if (trouble) return unwritable(folder, fmt::format("the folder cannot be made: {}", trouble.message()));
  SiteFolder site;
  site.folder_ = folder;
  if (!fs::exists(fs::path(folder) / list_name, trouble)) {
    const bool empty = fs::is_empty(folder, trouble);
    if (trouble) return unwritable(folder, fmt::format("the folder cannot be read: {}", trouble.message()));
    if (!empty)
      return unwritable(folder, "the folder holds other files than those of a site", "name a new or an empty folder");
    if (!write_whole(fs::path(folder) / list_name, "")) return unwritable(folder, "the folder cannot be written to");
  }
  site.earlier_ = site_files(folder);
  return site;
}

Result<> SiteFolder::put(const std::string& path, std::string_view bytes) {
  const fs::path place = fs::path(folder_) / path;
  if (!is_site_path(path)) return unwritable(path, "this is no path of a site");
  {
    const std::lock_guard guard(*lock_);
    current_.insert(path);
    // It is listed before it is there, so that no build leaves a file that nobody removes.
    if (earlier_.insert(path).second) {
      std::ofstream list(fs::path(folder_) / list_name, std::ios::app);
      list << path << '\n';
    }
  }
  std::error_code trouble;
  if (fs::file_size(place, trouble) == bytes.size() && !trouble && whole_file(place) == bytes) return {};
  if (!write_whole(place, bytes)) return unwritable(place.string(), "the file cannot be written");
  const std::lock_guard guard(*lock_);
  changed_.insert(path);
  return {};
}

bool SiteFolder::keep(const std::string& path) {
  std::error_code trouble;
  const std::lock_guard guard(*lock_);
  if (!earlier_.contains(path) || !fs::is_regular_file(fs::path(folder_) / path, trouble)) return false;
  current_.insert(path);
  return true;
}

std::string SiteFolder::bytes_of(const std::string& path) const {
  return is_site_path(path) ? whole_file(fs::path(folder_) / path) : std::string();
}

std::string SiteFolder::notes() const { return whole_file(fs::path(folder_) / notes_name); }

Result<> SiteFolder::finish(std::string_view notes) {
  std::error_code trouble;
  std::string list;
  for (const std::string& path : current_) list += path + "\n";
  for (const std::string& path : earlier_) {
    if (current_.contains(path)) continue;
    if (fs::remove(fs::path(folder_) / path, trouble)) changed_.insert(path);
    // A folder goes with its last file.
    fs::remove((fs::path(folder_) / path).parent_path(), trouble);
  }
  const fs::path notes_path = fs::path(folder_) / notes_name, list_path = fs::path(folder_) / list_name;
  if (whole_file(notes_path) != notes && !write_whole(notes_path, notes))
    return unwritable(folder_, "the notes of the site cannot be written");
  if (whole_file(list_path) != list && !write_whole(list_path, list))
    return unwritable(folder_, "the list of the site's files cannot be written");
  earlier_ = current_;
  return {};
}

}  // namespace wale
