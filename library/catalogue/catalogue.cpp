#include "wale/catalogue.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "compiler/modules/find_materials.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/modules/meant_material.hpp"
#include "library/by_name/missing_folder.hpp"
#include "library/index/content_hash.hpp"

namespace wale {
namespace {

class LibraryCatalogue final : public Catalogue {
 public:
  explicit LibraryCatalogue(const LibraryOptions& options) : missing_(missing_folder(options.folders)) {
    const auto resolver = file_resolver(library_folders(options.folders, std::getenv("WALE_LIBRARY")));
    index_ = library_index(*resolver, "here");
  }

  std::vector<CatalogueEntry> search(std::string_view words, std::string_view kind) const override {
    std::vector<std::string> texts;
    std::istringstream in{std::string(words)};
    for (std::string word; in >> word;) texts.push_back(word);
    std::vector<CatalogueEntry> entries;
    for (const FoundMaterial& found : find_materials(*index_, texts, kind))
      if (found.material->origin != Origin::hidden) entries.push_back(entry(*found.material));
    return entries;
  }

  Result<> folders_exist() const override {
    if (missing_) return *missing_;
    return {};
  }

  std::vector<std::string> kinds() const override { return kinds_in(*index_); }

 private:
  CatalogueEntry entry(const IndexedMaterial& material) const {
    auto meant = index_->meant_by(material.name);
    keep_preferred(meant, {});
    const bool is_alone = meant.size() == 1 && meant.front() == &material;
    return {.name = material.name,
            .spelling = is_alone ? material.name : material.module + "." + material.name,
            .module = material.module,
            .title = material.title,
            .kind = material.kind,
            .called = material.called,
            .feels = material.feels,
            .documentation = material.documentation,
            .shipped = material.shipped(),
            .content = material.shipped()
                           ? ContentHash().take(compiler_build()).take(material.module).take(material.name).digits()
                           : std::string()};
  }

  std::optional<Error> missing_;  // about the first of the given folders that is none
  std::shared_ptr<const LibraryIndex> index_;
};

}  // namespace

std::unique_ptr<Catalogue> library_catalogue(const LibraryOptions& options) {
  return std::make_unique<LibraryCatalogue>(options);
}

}  // namespace wale
