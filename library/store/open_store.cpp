#include <algorithm>
#include <array>

#include "library/store/stores.hpp"

namespace wale {
namespace {

constexpr std::array<std::string_view, 2> schemes = {"postgresql://", "postgres://"};
constexpr std::string_view hidden = "***";

}  // namespace

bool is_shared_address(std::string_view text) {
  return std::ranges::any_of(schemes, [&](std::string_view scheme) { return text.starts_with(scheme); });
}

std::string without_password(std::string_view address) {
  std::string shown(address);
  const std::size_t scheme = shown.find("://");
  if (scheme == std::string::npos) return shown;
  const std::size_t begin = scheme + 3;
  // A password may hold each sign that ends it, unescaped by mistake: so all up to the last @ is hidden.
  const std::size_t end = shown.rfind('@');
  if (end != std::string::npos && end >= begin)
    if (const std::size_t colon = shown.find(':', begin); colon < end) shown.replace(colon + 1, end - colon - 1, hidden);
  for (std::size_t at = 0; (at = shown.find("password=", at)) != std::string::npos;) {
    at += std::string_view("password=").size();
    const std::size_t value_end = std::min(shown.find('&', at), shown.size());
    shown.replace(at, value_end - at, hidden);
  }
  return shown;
}

Result<std::unique_ptr<LibraryStore>> LibraryStore::open(const std::string& where, bool makes, const std::string& cache) {
  return is_shared_address(where) ? open_shared_store(where, makes, cache) : open_sqlite_store(where, makes);
}

}  // namespace wale
