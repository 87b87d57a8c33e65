#pragma once

#include <string>
#include <vector>
#include <wale/language_service.hpp>

#include "document/placed.hpp"

namespace sandpaper {

/// A file with a recipe in it.
struct WithRecipe {
  Contents contents;
  std::vector<std::string> patches;  ///< the names of those that it brought
};

/// The blocks of Wale in a page of Markdown, whole and in order. Where a block names a picture that lies in `folder`,
/// the name becomes the picture's path.
std::vector<std::string> recipes_of(const std::string& page, const std::string& folder);

/// A Wale text in which the names of pictures and tables that lie in `folder` are their paths.
std::string with_paths(const std::string& text, const std::string& folder);

/// Puts the declarations of a recipe, a whole file, in front of the workspace of `contents`, and patches of it with
/// `at` as their middle: those of the workspace that is called so (empty: of the first), or one of its first material. A material whose name is taken
/// gets a new one. What comes out may have errors if the recipe has, or if its functions have names that are taken.
WithRecipe with_recipe(const wale::LanguageService& language, const Contents& contents, const std::string& recipe,
                       glm::dvec2 at, const std::string& workspace = {});

}  // namespace sandpaper
