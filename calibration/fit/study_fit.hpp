#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibration/analysis/adjustment.hpp"
#include "calibration/analysis/confidence.hpp"
#include "calibration/analysis/descriptions.hpp"
#include "calibration/analysis/detection.hpp"
#include "calibration/analysis/magnitude.hpp"
#include "calibration/analysis/scaling.hpp"
#include "calibration/analysis/sensitivity_law.hpp"
#include "calibration/analysis/sorting.hpp"
#include "calibration/fit/study.hpp"

namespace wale {

/// Where the law of a map comes from.
enum class FitModel {
  mixed,             ///< a linear mixed model of all log10 answers, observers random
  thesis,            ///< least squares of means of log10 answers, as Minsky 1995, section 5.3, has them
  thesis_equalised,  ///< the same after each observer's mean is moved to that of all
};

/// What is fitted, and what the trials do not say. Empty texts are found in the trials.
struct FitRequest {
  FitModel model = FitModel::mixed;
  std::string task;                ///< a name of `trial_task_names`
  analysis::TrialColumns columns;  ///< sizes and factors; without any those that the study varied
  std::string over;                ///< the size that a threshold is sought of
  std::optional<double> standard;  ///< that it is compared with, in its unit
  std::string about;               ///< the percept of a map, the cue of a threshold, the name of a rule
  std::string carrier;             ///< the argument of the map
  std::string name, domain;        ///< of the record
  std::vector<analysis::WordCode> codes;  ///< of descriptions
};

/// A threshold of one observer, or of all their answers.
struct ObserverThreshold {
  std::string observer;
  double value = 0;             ///< the difference at d' = 1; a fraction of the standard, or in the size's unit
  analysis::Interval interval;  ///< 95 %
  std::string refused;          ///< why there is none; then nothing else is set
};

/// Thresholds about one standard.
struct ThresholdFit {
  std::string standard;                               ///< "reference 0.8 N"; empty if there is one
  double size = 0;                                    ///< of the standard; 0: none
  std::vector<analysis::Level> levels;                ///< differences and answers of all observers
  analysis::SensitivityLaw law;                       ///< of all: with their threshold, and the common exponent and lapse
  std::vector<std::pair<double, analysis::Sensitivity>> sensitivities;  ///< of these tasks: d' at each difference
  std::vector<ObserverThreshold> observers;
  ObserverThreshold all;  ///< the geometric mean of the observers', or that of all answers
  std::string how;        ///< which of them
  std::size_t count = 0;  ///< of observers that `all` is of; those who were left out are not among them
};

/// What was set to be like one standard.
struct SettingsFit {
  std::string standard;          ///< its name, and the conditions
  std::optional<double> size;    ///< of the standard, if the trials say it
  analysis::Settings settings;
};

/// What stimuli were called.
struct DescriptionFit {
  std::vector<std::string> names;    ///< of the stimuli
  std::vector<std::size_t> trials;   ///< the first trial with each
  std::vector<analysis::DescribedStimulus> stimuli;
  analysis::DescribedStimulus all;
  bool is_coded = false;
};

/// The sorts into one number of groups, and their common groups: single linkage of these sorts alone, cut into so many.
struct GroupsFit {
  std::size_t groups = 0, sorts = 0;
  analysis::Grouping clusters;
  std::vector<std::size_t> distances;  ///< of each sort from the clusters: how many stimuli would have to be moved
};

struct SortingFit {
  std::vector<std::string> stimuli;  ///< their names
  std::vector<std::size_t> trials;   ///< a trial with each
  std::vector<analysis::Grouping> groupings;
  std::vector<analysis::Merge> single, average, complete;
  std::size_t groups = 2;       ///< that most sorts have
  analysis::Grouping clusters;  ///< of single linkage, so many
  double agreement = 0;         ///< mean adjusted Rand index of the sorts with the clusters
  std::vector<GroupsFit> by_groups;
  /// A map in two dimensions of how often stimuli were apart, ordinal; nothing where there is none, and then why.
  std::optional<analysis::Configuration> map;
  std::string map_refused;
};

/// A study as it was analysed. What its task gives is set.
struct StudyFit {
  std::string task, evidence;  ///< the grade: "simulated", "measured", "estimated"
  std::string evidence_reason;
  std::string no_record;  ///< why a map or rule of these trials would say nothing; empty if it says something
  analysis::Trials trials;
  std::vector<std::string> notes;
  std::optional<analysis::MagnitudeAnalysis> magnitudes;
  std::vector<ThresholdFit> thresholds;
  bool is_fraction = false;     ///< of thresholds: fractions of the standard
  std::optional<double> least_standard;  ///< the smallest, in the unit of the size; nothing for ratios and from nothing
  std::size_t catch_trials = 0;          ///< trials with nothing to find, which are not among `trials`
  std::string over, over_unit;  ///< the size of thresholds
  std::optional<analysis::WeberRange> weber;
  std::optional<analysis::ConfidenceAnalysis> confidence;
  std::optional<SortingFit> sorting;
  std::vector<SettingsFit> settings;
  std::optional<double> settings_scatter;  ///< pooled over the standards
  analysis::Interval settings_interval;
  std::optional<DescriptionFit> descriptions;
};

/// Analyses a study by its task.
///
/// Errors: those of `read_trials`, with file and row, and of the analyses; W0801 where the task, the answers or the
/// sizes are not known; W0802 for fewer than two observers of magnitudes, and where the trials do not determine the
/// law.
Result<StudyFit> fit_study(const Study& study, const FitRequest& request);

/// Part of `fit_study`: thresholds of forced choice, one interval, and same or different.
Result<> fit_thresholds(const Study& study, const FitRequest& request, const analysis::TrialColumns& columns,
                        StudyFit& fit);

/// Parts of `fit_study`: settings of an adjustment, and words of descriptions.
Result<> fit_settings(const Study& study, const FitRequest& request, StudyFit& fit);
Result<> fit_descriptions(const Study& study, const FitRequest& request, StudyFit& fit);

/// The size of a standard that a cell says: a number, with its unit or without, or the name of a presentation.
std::optional<double> standard_in_cell(std::string_view cell, const std::string& argument, const std::string& unit);

/// The record as a Wale file: a `map`, `threshold` or `rule` that compiles, with its provenance. The same trials and
/// request give the same text.
Result<std::string> record_of(const Study& study, const StudyFit& fit, const FitRequest& request);

/// What a terminal shows, and what machines read.
std::string fit_text(const Study& study, const StudyFit& fit, const FitRequest& request);
std::string fit_json(const Study& study, const StudyFit& fit, const FitRequest& request, const std::string& record);

const char* fit_model_name(FitModel model);

/// The coefficients of the law that a map gets: the exponent, and log10 magnitude at size 1.
struct ChosenLaw {
  analysis::Coefficient exponent, constant;
};
ChosenLaw chosen_law(const analysis::MagnitudeAnalysis& analysis, FitModel model);

}  // namespace wale
