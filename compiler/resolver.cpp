#include "compiler/resolver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace wale {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t largest_file = std::uintmax_t{512} << 20;

class FileResolver final : public Resolver {
 public:
  explicit FileResolver(std::vector<std::string> roots) : roots_(std::move(roots)) {}

  std::variant<ResolvedFile, ResolveProblem> module(const std::string& path, const std::string& from) override {
    std::string relative = path;
    std::ranges::replace(relative, '.', '/');
    return look_for(relative + ".wale", from);
  }

  std::variant<ResolvedFile, ResolveProblem> file(const std::string& name, const std::string& from) override {
    return look_for(name, from);
  }

 private:
  std::variant<ResolvedFile, ResolveProblem> look_for(const std::string& name, const std::string& from) {
    std::vector<fs::path> candidates{fs::path(from).parent_path() / name};
    for (const auto& root : roots_) candidates.push_back(fs::path(root) / name);
    for (const auto& candidate : candidates) {
      std::error_code ignored;
      if (fs::exists(candidate, ignored)) return read_file(candidate.lexically_normal().string());
    }
    std::string searched;
    for (const auto& candidate : candidates)
      searched += fmt::format("{}`{}`", searched.empty() ? "" : ", ", candidate.lexically_normal().string());
    return ResolveProblem{fmt::format("no such file; looked for {}", searched)};
  }

  std::vector<std::string> roots_;
};

}  // namespace

std::unique_ptr<Resolver> file_resolver(std::vector<std::string> roots) {
  return std::make_unique<FileResolver>(std::move(roots));
}

std::variant<ResolvedFile, ResolveProblem> read_file(const std::string& path) {
  std::error_code error;
  const auto status = fs::status(path, error);
  if (!fs::exists(status)) return ResolveProblem{"no such file"};
  if (fs::is_directory(status)) return ResolveProblem{"this is a folder"};
  // A pipe has no size and may never end; only regular files are measured before they are read.
  if (fs::is_regular_file(status)) {
    const auto size = fs::file_size(path, error);
    if (!error && size > largest_file) return ResolveProblem{fmt::format("{} bytes are more than Wale reads", size)};
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return ResolveProblem{std::strerror(errno)};
  ResolvedFile file{path, {}};
  char block[1 << 16];
  while (stream.read(block, sizeof block), stream.gcount() > 0) {
    file.bytes.append(block, static_cast<std::size_t>(stream.gcount()));
    if (file.bytes.size() > largest_file) return ResolveProblem{"more bytes than Wale reads"};
  }
  if (stream.bad()) return ResolveProblem{std::strerror(errno)};
  return file;
}

}  // namespace wale
