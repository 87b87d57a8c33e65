#include "calibration/fit/study_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/text/readable.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

/// More rows than this make a page that browsers are slow with.
constexpr std::size_t most_rows = 2000;

/// Text in HTML. Control characters are shown and not obeyed; in lines, line ends stay.
std::string escaped(std::string_view text, bool lines = false) {
  const std::string visible = lines ? visible_lines(text) : visible_text(text);
  std::string safe;
  for (const char c : visible) switch (c) {
      case '&': safe += "&amp;"; break;
      case '<': safe += "&lt;"; break;
      case '>': safe += "&gt;"; break;
      case '"': safe += "&quot;"; break;
      case '\'': safe += "&#39;"; break;
      default: safe += c;
    }
  return safe;
}

std::string in_base64(const std::vector<std::byte>& bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[three >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string figure(const PagePicture& picture) {
  return fmt::format("<figure><img alt=\"{0}\" src=\"data:{1};base64,{2}\"><figcaption>{0}</figcaption></figure>\n",
                     escaped(picture.title), picture.type, in_base64(picture.bytes));
}

std::string lines(std::string_view text) { return "<pre>" + escaped(text, true) + "</pre>\n"; }
std::string paragraph(std::string_view text) { return text.empty() ? "" : "<p>" + escaped(text) + "</p>\n"; }
std::string heading(const char* text) { return fmt::format("<h2>{}</h2>\n", text); }

std::string row(const std::vector<std::string>& cells, const char* kind = "td") {
  std::string text = "<tr>";
  for (const std::string& each : cells) text += fmt::format("<{0}>{1}</{0}>", kind, escaped(each));
  return text + "</tr>\n";
}

std::string raw_data(const analysis::Trials& trials) {
  std::vector<std::string> names = {"file", "row", "observer", "run"};
  for (const auto& each : trials.sizes)
    names.push_back(each.unit.empty() ? each.name : each.name + " (" + each.unit + ")");
  for (const auto& each : trials.factors) names.push_back(each.name);
  names.emplace_back("answer");
  std::string text = "<details><summary>all answers that were analysed</summary>\n<table>\n" + row(names, "th");
  for (std::size_t i = 0; i < std::min(trials.size(), most_rows); ++i) {
    std::vector<std::string> cells = {trials.files[trials.file[i]], std::to_string(trials.line[i]),
                                      trials.observers[trials.observer[i]],
                                      trials.runs.empty() ? "" : trials.runs[trials.run[i]]};
    for (const auto& each : trials.sizes) cells.push_back(fmt::format("{:.6g}", each.values[i]));
    for (const auto& each : trials.factors) cells.push_back(each.levels[each.values[i]]);
    cells.push_back(trials.labels.empty() ? fmt::format("{:.6g}", trials.answer[i])
                                          : trials.labels[static_cast<std::size_t>(trials.answer[i])]);
    text += row(cells);
  }
  text += "</table>\n";
  if (trials.size() > most_rows)
    text += paragraph(readable("{} more rows are in the files and not on this page.", trials.size() - most_rows));
  return text + "</details>\n";
}

std::string exclusions(const analysis::Trials& trials) {
  if (trials.exclusions.empty()) return paragraph("No row is excluded.");
  std::string text = paragraph(readable("{} rows are excluded, each by a rule.", trials.exclusions.size()));
  text += "<table>\n" + row({"rule", "rows"}, "th");
  for (std::size_t rule = 0; rule < trials.rules.size(); ++rule)
    text += row(
        {trials.rules[rule], readable("{}", std::ranges::count(trials.exclusions, rule, &analysis::Exclusion::rule))});
  text += "</table>\n<details><summary>each row</summary>\n<table>\n" + row({"file", "row", "rule"}, "th");
  for (std::size_t i = 0; i < std::min(trials.exclusions.size(), most_rows); ++i) {
    const analysis::Exclusion& each = trials.exclusions[i];
    text += row({trials.files[each.file], std::to_string(each.line), trials.rules[each.rule]});
  }
  text += "</table>\n";
  if (trials.exclusions.size() > most_rows)
    text += paragraph(readable("{} more are not on this page.", trials.exclusions.size() - most_rows));
  return text + "</details>\n";
}

std::string moved(const StudyPageParts& parts) {
  std::string text = paragraph(parts.moved_note);
  if (parts.moved.empty()) return text;
  text += "<table>\n" + row({"material", "level asked", "size before", "size with this map",
                             "just noticeable differences", "the size before reads as"},
                            "th");
  for (const MovedMaterial& each : parts.moved)
    text += row({each.name, fmt::format("{:.3g}", each.level), fmt::format("{:.4g} {}", each.before, each.unit),
                 fmt::format("{:.4g} {}", each.after, each.unit), fmt::format("{:.1f}", each.noticeable),
                 fmt::format("{:.3g}", each.now_reads)});
  return text + "</table>\n";
}

}  // namespace

std::string study_page(const Study& study, const StudyFit& fit, const FitRequest& request, const std::string& record,
                       const StudyPageParts& parts) {
  const std::string title = study.experiment.empty() ? "study" : study.experiment;
  std::string text = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src "
      "'unsafe-inline'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n<style>\n"
      "body {{ font: 16px/1.5 sans-serif; color: #222; background: #fdfcf9; max-width: 60em; margin: 2em auto; "
      "padding: 0 1em }}\n"
      "pre {{ overflow-x: auto; background: #f4f2ec; padding: 1em; font-size: 13px }}\n"
      "table {{ border-collapse: collapse; font-size: 14px }} th, td {{ text-align: left; padding: .2em .8em .2em 0; "
      "border-bottom: 1px solid #ddd }}\n"
      "figure {{ display: inline-block; margin: .5em }} img {{ max-width: 100% }} figcaption {{ font-size: 14px; "
      "color: #666 }}\n"
      ".grade {{ border-left: 4px solid #cc6b2c; padding-left: 1em }}\n</style>\n</head>\n<body>\n<h1>{}</h1>\n",
      escaped(title), escaped(title));
  text += fmt::format("<p class=\"grade\">Evidence: <b>{}</b>, {}.</p>\n", escaped(fit.evidence),
                      escaped(fit.evidence_reason));
  text += heading("Where it comes from") + "<table>\n" + row({"file", "form", "hash (FNV-1a, 64 bits)"}, "th");
  for (const StudyFile& each : study.files) text += row({each.path, each.form, fmt::format("{:016x}", each.hash)});
  text += "</table>\n";
  std::string versions;
  for (const std::string& each : study.versions) versions += (versions.empty() ? "" : ", ") + each;
  text += paragraph(fmt::format("Data of {}; device {}; software {}; {} programs were felt.",
                                study.first_day.empty()             ? "an unknown day"
                                : study.first_day == study.last_day ? study.first_day
                                                                    : study.first_day + " to " + study.last_day,
                                study.device.empty() ? "not stated" : study.device,
                                versions.empty() ? "not stated" : versions, study.programs.size()));
  text += heading("Design");
  text += study.design.empty() ? paragraph("The files do not hold the design.")
                               : "<details><summary>as written</summary>\n" + lines(study.design) + "</details>\n";
  text += heading("Stimuli") + paragraph(parts.stimuli_note);
  for (const PagePicture& each : parts.stimuli) text += figure(each);
  text += heading("Results") + lines(fit_text(study, fit, request));
  for (const PagePicture& each : parts.charts) text += figure(each);
  text += heading("Raw data") + raw_data(fit.trials);
  text += heading("Exclusions") + exclusions(fit.trials);
  text += heading("The record as it will be used") + (fit.no_record.empty() ? lines(record) : paragraph("None is made: " + fit.no_record + "."));
  if (fit.magnitudes) text += heading("What it changes in the library") + moved(parts);
  return text + "</body>\n</html>\n";
}

}  // namespace wale
