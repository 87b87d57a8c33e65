#pragma once

#include <initializer_list>
#include <optional>
#include <string_view>

#include "compiler/expression/reading.hpp"

namespace wale {

/// The value of a name in the scope, of the hand or the patch, or of a constant. Unknown names are reported.
Value value_of_name(ExpressionReading& reading, const Word& word, Scope& scope);
/// The value of a name that the scope binds.
Value bound_value(ExpressionReading& reading, Scope::Binding& binding, Span span, Scope& scope);
/// The value of a name that the scope does not bind.
Value free_value(ExpressionReading& reading, const Word& word, Scope& scope);

/// Whether a name has a value here. For `hand.x`, the part before the dot decides.
bool has_value(const ExpressionReading& reading, std::string_view name, const Scope& scope);

/// Reports a name that an imported file declares without `export`, if there is one.
std::optional<Value> private_name(ExpressionReading& reading, const Word& word);

/// The import that brings a name which a module of the library exports as one of `kinds` ("unit", "map"); empty where
/// there is none.
[[gnu::cold]] std::optional<Advice> import_mend(const Surroundings& surroundings, std::string_view name,
                                                std::initializer_list<std::string_view> kinds);

/// The names of all functions that can be called with so many arguments: one that takes fewer was not meant by whoever
/// misspelt its name.
[[gnu::cold]] std::vector<std::string> functions_that_take(const Declarations& names, std::size_t arguments);

enum class Sought { value, function };
/// The advice for an unknown name: "did you mean …", or the import that declares it, or else `otherwise`. `scope` may
/// be null. `arguments` are those that a function is called with.
[[gnu::cold]] Advice spelling_mend(ExpressionReading& reading, const Word& word, const Scope* scope, Sought sought,
                                   Advice otherwise, std::size_t arguments = 0);

}  // namespace wale
