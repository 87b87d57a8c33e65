#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

// Texts that grow, one construct of the language at a time or one inside another, to find those for which the compiler
// does more work than the text deserves.

namespace wale::growing {

/// An expression and what it needs before it.
struct Part {
  std::string declarations;  ///< of the file
  std::string statements;    ///< of the physical block
  std::string value;         ///< a plain number that changes with the place
};

/// A construct of expressions: `grow(prefix, n, inner)` uses n of it, the innermost on `inner`. Names begin with the
/// prefix.
struct Expressions {
  const char* name;
  std::function<Part(const std::string& prefix, int n, const std::string& inner)> grow;
};

/// A construct of materials: `grow(n, declarations, perceptual, physical)` is a whole file. The physical block is of
/// the first material.
struct Materials {
  const char* name;
  std::function<std::string(int n, const std::string& declarations, const std::string& perceptual,
                            const std::string& physical)>
      grow;
};

/// A construct of files, such as many errors or long names.
struct Texts {
  const char* name;
  std::function<std::string(int n)> grow;
};

inline std::string repeated(int n, const std::function<std::string(int)>& part) {
  std::string text;
  for (int i = 0; i < n; ++i) text += part(i);
  return text;
}

/// `let p1 = …p0…`, n times: each statement uses the one before it as `{1}`.
inline Part chain_of_lets(const std::string& p, int n, const std::string& inner, const std::string& step) {
  return {"",
          fmt::format("let {}0 = {}\n", p, inner) +
              repeated(n,
                       [&](int i) {
                         return fmt::format("let {}{} = {}\n", p, i + 1,
                                            fmt::format(fmt::runtime(step), fmt::format("{}{}", p, i), i));
                       }),
          fmt::format("{}{}", p, n)};
}

/// `function p1(t) = …p0…`, n times: each uses the one before it as `{0}`.
inline Part chain_of_functions(const std::string& p, int n, const std::string& inner, const std::string& step) {
  return {fmt::format("function {}0(t) = sin(t)\n", p) +
              repeated(n,
                       [&](int i) {
                         return fmt::format("function {}{}(t) = {}\n", p, i + 1,
                                            fmt::format(fmt::runtime(step), fmt::format("{}{}", p, i), i));
                       }),
          "", fmt::format("{}{}({})", p, n, inner)};
}

inline Expressions lets(const char* name, const char* step) {
  return {name,
          [step](const std::string& p, int n, const std::string& inner) { return chain_of_lets(p, n, inner, step); }};
}
inline Expressions functions(const char* name, const char* step) {
  return {name, [step](const std::string& p, int n, const std::string& inner) {
            return chain_of_functions(p, n, inner, step);
          }};
}
inline Expressions nested(const char* name, const char* before, const char* after) {
  return {name, [before, after](const std::string&, int n, const std::string& inner) {
            const auto part = [](const char* text) { return [text](int) { return std::string(text); }; };
            return Part{"", "", repeated(n, part(before)) + inner + repeated(n, part(after))};
          }};
}

inline std::vector<Expressions> expressions() {
  return {
      lets("sums of a let with itself", "{0} + {0}"),
      lets("products of a let", "{0} * ({0} + 1)"),
      lets("conditions", "if {0} < 0.5 then {0} + 1 else {0} * 2"),
      lets("powers", "{0}^15"),
      lets("roots", "abs({0})^0.3"),
      lets("gradients", "length(grad({0})) * 1 mm"),
      lets("gradients of products", "grad({0} * sin({0})).x * 1 mm"),
      lets("peaks", "{0} / peak({0})"),
      lets("peaks of sums", "sin({0} + peak({0} * {1}))"),
      lets("curves", "curve(0, 0, 1, 1, 2, 0, 3, 1)({0})"),
      lets("noise", "noise3({0}, x / 1 mm, y / 1 mm)"),
      lets("vectors", "rotate(vector({0}, {0}), 30 deg).x"),
      lets("held", "hold(vector({0}, {0}), 1).x"),
      lets("phases", "sin({0}) * phase(2 Hz)"),
      functions("functions of different values", "{0}(t) * {0}(t + {1})"),
      functions("functions of the same value", "{0}(t) + {0}(t)"),
      functions("functions of functions", "{0}({0}(t))"),
      functions("functions in conditions", "if t < {1} then {0}(t) else {0}(t + 1)"),
      nested("parentheses", "(", ")"),
      nested("signs", "-(", ")"),
      nested("calls", "sin(", ")"),
      nested("calls of the library", "smootherstep(", ")"),
      {"a sum",
       [](const std::string&, int n, const std::string& inner) {
         return Part{"", "", "(" + inner + repeated(n, [&](int) { return " + " + inner; }) + ")"};
       }},
      {"constants",
       [](const std::string& p, int n, const std::string& inner) {
         return Part{fmt::format("let {}0 = 0.5\n", p) +
                         repeated(n, [&](int i) { return fmt::format("let {0}{1} = {0}{2} + {0}{2}\n", p, i + 1, i); }),
                     "", fmt::format("({} + {}{})", inner, p, n)};
       }},
      {"defaults of arguments",
       [](const std::string& p, int n, const std::string& inner) {
         return Part{fmt::format("function {}0(t, u = 2) = sin(t + u)\n", p) +
                         repeated(n,
                                  [&](int i) {
                                    return fmt::format("function {0}{1}(t, u = {0}{2}(1), v = {0}{2}(2)) = {0}{2}(t)\n",
                                                       p, i + 1, i);
                                  }),
                     "", fmt::format("{}{}({})", p, n, inner)};
       }},
      {"points of a curve",
       [](const std::string& p, int n, const std::string& inner) {
         const std::string points = repeated(n + 2, [](int i) { return fmt::format("{0}{1}, {1}", i ? ", " : "", i); });
         return Part{
             "",
             fmt::format("let {}0 = curve({})\n", p, points) +
                 repeated(n, [&](int i) { return fmt::format("let {0}v{1} = {0}0({2} + {1})\n", p, i, inner); }),
             "(0" + repeated(n, [&](int i) { return fmt::format(" + {}v{}", p, i); }) + ")"};
       }},
      {"parameters",
       [](const std::string& p, int n, const std::string& inner) {
         return Part{"", repeated(n, [&](int i) { return fmt::format("param {}{} = 1 in 0 .. 2\n", p, i); }),
                     "(" + inner + repeated(n, [&](int i) { return fmt::format(" + {}{}", p, i); }) + ")"};
       }},
      {"states",
       [](const std::string& p, int n, const std::string& inner) {
         return Part{"",
                     repeated(n,
                              [&](int i) {
                                return fmt::format(
                                    "state {0}{1} = 0 in 0 .. 1\nnext {0}{1} = {0}{1} * 0.5 + {2} * 0.1\n", p, i,
                                    i ? fmt::format("{}{}", p, i - 1) : inner);
                              }),
                     n ? fmt::format("{}{}", p, n - 1) : inner};
       }},
      {"tables",
       [](const std::string& p, int n, const std::string& inner) {
         return Part{"", repeated(n, [&](int i) { return fmt::format("let {}{} = table(\"relation.csv\")\n", p, i); }),
                     "(" + inner + repeated(n, [&](int i) { return fmt::format(" + {}{}(x) / 1 N", p, i); }) + ")"};
       }},
  };
}

inline std::string material(const std::string& name, const std::string& perceptual, const std::string& physical) {
  const std::string asked = perceptual.empty() ? "" : fmt::format("perceptual {{ {} }} ", perceptual);
  return fmt::format("material {} {{ {}physical {{\nparam k = 1 in 0 .. 9\n{}}} }}\n", name, asked, physical);
}

inline std::vector<Materials> materials() {
  using Text = const std::string&;
  const auto chain = [](const char* name, const char* step) {
    return Materials{name, [step](int n, Text declarations, Text perceptual, Text physical) {
                       return "wale 1\n" + declarations + material("m0", perceptual, physical) +
                              repeated(n, [&](int i) { return fmt::format(fmt::runtime(step), i + 1, i) + "\n"; });
                     }};
  };
  const auto flat = [](const char* name, const char* component) {
    return Materials{name, [component](int n, Text declarations, Text perceptual, Text physical) {
                       return "wale 1\n" + declarations + material("m0", perceptual, physical) + "material m1 = 1 m0" +
                              repeated(n, [&](int i) { return fmt::format(fmt::runtime(component), i + 1); }) + "\n";
                     }};
  };
  return {
      {"one material", [](int, Text declarations, Text perceptual,
                          Text physical) { return "wale 1\n" + declarations + material("m0", perceptual, physical); }},
      chain("blends of one material", "material m{0} = 0.5 m{1} + 0.5 m{1}"),
      chain("blends of settings", "material m{0} = 0.5 * m{1}(k: 2) + 0.5 * m{1}(k: 3)"),
      chain("blends of weights", "material m{0} = 0.5 * m{1} + 0.4 * between(m{1}, m{1}, 0.5)"),
      chain("settings", "material m{0} = m{1}(k: 2)"),
      chain("`like`",
            "material m{0} {{ representative {{ like m{1} }} physical {{ force f{0} = viscous(1 N s/m) }} }}"),
      chain("`like` of a blend",
            "material m{0} = 0.5 m{1} + 0.5 m{1} {{ physical {{ force f{0} = viscous(1 N s/m) }} }}"),
      chain("`between`", "material m{0} = between(m{1}, m{1}(k: 2), 0.5)"),
      flat("components", " + 0.1 m0"),
      flat("components with settings", " + 0.1 * m0(k: 2)"),
      {"materials",
       [](int n, Text declarations, Text perceptual, Text physical) {
         return "wale 1\n" + declarations +
                repeated(n + 1, [&](int i) { return material(fmt::format("m{}", i), perceptual, physical); });
       }},
      {"layers of `like`",
       [](int n, Text declarations, Text perceptual, Text physical) {
         const auto forces = [&](const char* kind) {
           return repeated(n, [&](int i) { return fmt::format("force f{} = {}\n", i, kind); });
         };
         return "wale 1\n" + declarations + material("m0", perceptual, physical + forces("viscous(1 N s/m)")) +
                "material m1 { representative { like m0 } physical {\n" + forces("spring(1 N/m)") + "} }\n";
       }},
  };
}

inline Texts lines(const char* name, const char* line) {
  return {name, [line](int n) {
            return "wale 1\n" + repeated(n, [&](int i) { return fmt::format(fmt::runtime(line), i, i + 1); });
          }};
}
inline Texts in_material(const char* name, const char* statement, const char* end) {
  return {name, [statement, end](int n) {
            return "wale 1\nmaterial m {\nphysical {\n" +
                   repeated(n, [&](int i) { return fmt::format(fmt::runtime(statement), i, i + 1); }) + end +
                   "\n}\n}\n";
          }};
}

/// Laws of maps that grow.
inline std::vector<Texts> laws() {
  return {
      {"a law of functions",
       [](int n) {
         return chain_of_functions("p", n, "", "{0}(t) + {0}(t)").declarations.insert(0, "wale 1\n") +
                fmt::format(
                    "map roughness from amplitude {{ name n; law magnitude = p{}(amplitude / 1 pu); valid "
                    "amplitude 9 pu .. 194 pu; scatter 0.1; observers 9; evidence slope measured, anchor "
                    "measured, handle measured; on sandpaper; source \"s\" }}\n",
                    n);
       }},
      {"a law of squares",
       [](int n) {
         return "wale 1\nfunction p0(t) = t + t * t\n" +
                repeated(n, [](int i) { return fmt::format("function p{}(t) = twice(p{}(t))\n", i + 1, i); }) +
                "function twice(t) = t + t\n" +
                fmt::format(
                    "percept r {{ words \"w\"; one lateral amplitude 1 N on sandpaper; zero nothing; extractor "
                    "lateral_force, period 1 mm .. 9 mm; cue amplitude; near_threshold 0.1 }}\n"
                    "map r from amplitude {{ name n; law magnitude = p{}(amplitude / 1 pu); branch rising; "
                    "valid amplitude 9 pu .. 194 pu; scatter 0.1; observers 9; evidence slope measured, anchor "
                    "measured, handle measured; on sandpaper; source \"s\" }}\n"
                    "material m {{ perceptual {{ r 0.5 }} physical {{ force = lateral(sin(x / 1 mm)) }} }}\n",
                    n);
       }},
  };
}

/// Files whose construct is no expression and no material, or that are wrong.
inline std::vector<Texts> texts() {
  std::vector<Texts> all = laws();
  for (Texts& each : std::vector<Texts>{
           lines("units", "unit u{1} = 2 mm\n"),
           lines("dimensions", "dimension d{1} = length * length\n"),
           lines("functions", "function f{1}(a) = a * f{0}(1)\n"),
           lines("comments", "/* {0} */ // {1}\n/// of nothing\n"),
           lines("unknown names", "let a{0} = nothing{0}\n"),
           lines("unknown functions", "let a{0} = nothing{0}(1)\n"),
           lines("unknown units", "let a{0} = 1 nothing{0}\n"),
           lines("names declared twice", "let a = 1\n"),
           lines("wrong dimensions", "let a{0} = 1 N + 1 m\n"),
           lines("unreadable lines", "let a{0} = = 1\n"),
           lines("percepts",
                 "percept p{0} {{ words \"w{0}\"; antonym q{0} \"v{0}\"; one lateral amplitude 1 N on sandpaper; zero "
                 "nothing; "
                 "extractor lateral_force, period 1 mm .. 9 mm; cue amplitude; near_threshold 0.1 }}\n"),
           lines(
               "maps",
               "map roughness from amplitude {{ name n{0}; law log10(magnitude) = 0.7 * log10(amplitude / 1 pu); valid "
               "amplitude 9 pu .. 194 pu; scatter 0.1; observers 9; evidence slope measured, anchor measured, handle "
               "measured; on sandpaper; source \"s\" }}\n"),
           lines("levels", "levels roughness {{ l{0} 0.1; r{0} 0.9 }}\n"),
           {"a sum of forces with itself",
            [](int n) {
              return "wale 1\nmaterial m {\nphysical {\nlet f0 = viscous(1 N s/m) + spring(1 N/m)\n" +
                     repeated(n, [](int i) { return fmt::format("let f{} = f{} + f{}\n", i + 1, i, i); }) +
                     fmt::format("force = f{}\n}}\n}}\n", n);
            }},
           {"a blend of a sum of forces with itself",
            [](int n) {
              return "wale 1\nmaterial m {\nphysical {\nlet f0 = viscous(1 N s/m) + spring(1 N/m)\n" +
                     repeated(n, [](int i) { return fmt::format("let f{} = f{} + f{}\n", i + 1, i, i); }) +
                     fmt::format("force = f{}\n}}\n}}\nmaterial b = 0.5 m + 0.5 m\n", n);
            }},
           {"percepts asked for",
            [](int n) {
              return "wale 1\nmaterial m {\nperceptual {\n" +
                     repeated(n, [](int) { return std::string("roughness 0.5\n"); }) + "}\n}\n";
            }},
           in_material("layers of force", "force f{0} = viscous(1 N s/m)\n", ""),
           in_material("open textures", "force f{0} = lateral(sin(x / {1} mm))\n", ""),
           in_material("fixed textures", "force f{0} = lateral(sin(x / {1} mm), amplitude: 1 N)\n", ""),
           in_material("heights", "height h{0} = sin(x / {1} mm)\n", "force = vector(1 N, 0 N)"),
           in_material("memories", "memory w{0} = 0 in 0 .. 1, cell 1 mm\n", "force = vector(1 N, 0 N)"),
           in_material("marks", "show circle(vector({0} mm, 0 mm), 1 mm)\n", "force = vector(1 N, 0 N)"),
           in_material("unused names", "let a{0} = {1}\n", "force = vector(1 N, 0 N)"),
           in_material("unknown names of a material", "let a{0} = b{0}\n", "force = vector(1 N, 0 N)"),
           in_material("long lines", "let a{0} = {1} * x / 1 mm;", "\nforce = vector(1 N, 0 N)"),
           in_material("errors in a long line", "let a{0} = {1} N + 1 mm;", "\nforce = vector(1 N, 0 N)"),
           {"a long name",
            [](int n) {
              const std::string name(static_cast<std::size_t>(16 * n), 'a');
              return "wale 1\nlet " + name + "a = 1\nlet b = " + name + "\nlet c = " + name + "c\n";
            }},
           {"a long text",
            [](int n) {
              return "wale 1\nmaterial m { representative { title \"" +
                     std::string(static_cast<std::size_t>(16 * n), 'a') +
                     "\" } physical { force = vector(1 N, 0 N) } }\n";
            }},
           {"blocks", [](int n) { return "wale 1\n" + repeated(n, [](int) { return std::string("material m {"); }); }},
       })
    all.push_back(std::move(each));
  return all;
}

}  // namespace wale::growing
