#include "panels/slider_panel.hpp"

#include <algorithm>
#include <cctype>
#include <set>

namespace sandpaper {
namespace {

constexpr int before_following = 250;  // ms

int merge_of(const std::string& slider) {
  return 100000 + static_cast<int>(std::hash<std::string>()(slider) % 1000000);
}

/// Whether a parameter is a weight of a blend: `denim_weight`, or `denim_weight_2` of the second denim (LANGUAGE.md,
/// Blends).
bool is_weight(std::string name) {
  while (!name.empty() && std::isdigit(static_cast<unsigned char>(name.back()))) name.pop_back();
  if (name.ends_with('_')) name.pop_back();
  return name.ends_with("_weight");
}

}  // namespace

SliderPanel::SliderPanel(Document& document, Feeling& feeling, QWidget* parent)
    : QWidget(parent), document_(document), feeling_(feeling), title_(new QLabel), area_(new QScrollArea) {
  title_->setTextFormat(Qt::PlainText);
  title_->setWordWrap(true);
  area_->setWidgetResizable(true);
  area_->setFrameShape(QFrame::NoFrame);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addWidget(title_);
  layout->addWidget(area_);
  waiting_.setSingleShot(true);
  connect(&waiting_, &QTimer::timeout, this, &SliderPanel::follow);
  connect(&document_, &Document::chosen_changed, this, &SliderPanel::follow);
  connect(&document_, &Document::contents_changed, this, &SliderPanel::refresh);
  connect(&feeling_, &Feeling::programs_changed, this, &SliderPanel::refresh);
  follow();
}

void SliderPanel::set_touched(std::optional<std::uint64_t> id) {
  if (!id) return;  // the sliders of the patch that was touched last stay
  touched_ = id;
  waiting_.start(before_following);
}

void SliderPanel::follow() {
  std::optional<std::uint64_t> next;
  if (document_.chosen().size() == 1) next = *document_.chosen().begin();
  else if (document_.chosen().empty()) next = touched_;
  if (next && !document_.contents().find(*next)) next.reset();
  if (next == shown_ && !rows_.empty()) return;
  shown_ = next;
  rebuild();
  emit shown_changed();
}

void SliderPanel::rebuild() {
  rows_.clear();
  auto* inside = new QWidget;
  auto* layout = new QVBoxLayout(inside);
  layout->setContentsMargins(0, 0, 0, 0);
  const Placed* placed = shown_ ? document_.contents().find(*shown_) : nullptr;
  const wale::Program* program = placed ? feeling_.program(placed->id) : nullptr;
  program_ = program ? &program->decoded() : nullptr;
  if (!placed) {
    title_->setText(document_.chosen().size() > 1
                        ? tr("%1 patches are chosen").arg(document_.chosen().size())
                        : tr("Touch or choose a patch to see its sliders."));
  } else if (!program) {
    const auto material = feeling_.material(placed->id);
    title_->setText(tr("%1: %2").arg(QString::fromStdString(placed->patch.name),
                                     material && !material->problems.empty()
                                         ? QString::fromStdString(wale::in_words(material->problems.front().error))
                                         : tr("compiling …")));
  } else {
    title_->setText(
        tr("%1 = %2").arg(QString::fromStdString(placed->patch.name), QString::fromStdString(placed->patch.made_of)));
    const wale::PatchProgram& described = program->description();
    std::set<std::size_t> percepts;
    for (const wale::PerceptRecord& each : described.percepts)
      if (each.parameter) percepts.insert(*each.parameter);
    // Percepts first, then parameters, then the weights of a blend.
    for (const int rank : {0, 1, 2})
      for (std::size_t i = 0; i < described.parameters.size(); ++i) {
        const wale::Parameter& parameter = described.parameters[i];
        const bool is_percept = percepts.contains(i);
        if (rank != (is_percept ? 0 : is_weight(parameter.name) ? 2 : 1)) continue;
        auto* row = new SliderRow(parameter, is_percept, feeling_.value(*placed, parameter), parameter.value);
        connect(row, &SliderRow::moved, this,
                [this, row](float value, bool is_final) { moved(*row, value, is_final); });
        connect(row, &SliderRow::reset_wanted, this, [this, row] { reset(*row); });
        connect(row, &SliderRow::mark_wanted, this, [this, row](bool high) { mark(*row, high); });
        connect(row, &SliderRow::unmark_wanted, this, [this, row] { mark(*row, std::nullopt); });
        connect(row, &SliderRow::says_wanted, this, [this, row](const QString& says) { say(*row, says); });
        layout->addWidget(row);
        rows_.push_back(row);
      }
    if (rows_.empty()) layout->addWidget(new QLabel(tr("This material has no parameters.")));
  }
  layout->addStretch();
  area_->setWidget(inside);
  refresh();
}

void SliderPanel::refresh() {
  const Placed* placed = shown_ ? document_.contents().find(*shown_) : nullptr;
  const wale::Program* program = placed ? feeling_.program(placed->id) : nullptr;
  if ((program ? &program->decoded() : nullptr) != program_ || (shown_ && !placed)) {
    if (shown_ && !placed) shown_.reset();
    return rebuild();
  }
  if (!program) return;
  title_->setText(
      tr("%1 = %2").arg(QString::fromStdString(placed->patch.name), QString::fromStdString(placed->patch.made_of)));
  for (SliderRow* row : rows_) {
    row->set_value(feeling_.value(*placed, row->parameter()));
    const auto mark = std::ranges::find_if(
        placed->patch.marks, [&](const wale::LaidOutMark& each) { return each.mark.slider == row->name(); });
    if (mark == placed->patch.marks.end()) row->set_marks({}, {}, {});
    else row->set_marks(mark->mark.low, mark->mark.high, QString::fromStdString(mark->mark.says));
  }
}

void SliderPanel::moved(const SliderRow& row, float value, bool is_final) {
  if (!shown_) return;
  feeling_.set(*shown_, row.name(), value);
  if (!is_final) return;
  const wale::Parameter& parameter = row.parameter();
  document_.set_argument(*shown_, row.name(), value, written(value, parameter.unit, parameter.unit_in_si),
                         merge_of(row.name()));
}

void SliderPanel::reset(const SliderRow& row) {
  if (!shown_) return;
  document_.change_placed(tr("Reset %1").arg(QString::fromStdString(row.name())), {*shown_}, [&](Placed& placed) {
    placed.sliders.erase(row.name());
    placed.patch.made_of = without_argument(placed.patch.made_of, row.name());
    // An argument that the author wrote comes back with its material.
    if (const auto own = placed.compiled_from; without_argument(own, row.name()) != own)
      placed.compiled_from = without_argument(own, row.name());
  });
}

void SliderPanel::mark(const SliderRow& row, std::optional<bool> high) {
  if (!shown_) return;
  document_.change_placed(high ? tr("Mark %1").arg(QString::fromStdString(row.name())) : tr("Remove a mark"), {*shown_},
                          [&](Placed& placed) {
                            auto& marks = placed.patch.marks;
                            auto found = std::ranges::find_if(
                                marks, [&](const wale::LaidOutMark& each) { return each.mark.slider == row.name(); });
                            if (!high) {
                              if (found != marks.end()) marks.erase(found);
                              return;
                            }
                            if (found == marks.end()) {
                              const wale::Parameter& parameter = row.parameter();
                              marks.push_back({.mark = {.slider = row.name(), .is_percept = row.is_percept()},
                                               .unit = parameter.unit,
                                               .unit_in_si = parameter.unit_in_si});
                              found = marks.end() - 1;
                            }
                            auto& mark = found->mark;
                            (*high ? mark.high : mark.low) = row.value();
                            // The end that was marked last counts.
                            if (mark.low && mark.high && *mark.low > *mark.high) (*high ? mark.low : mark.high).reset();
                          });
}

void SliderPanel::say(const SliderRow& row, const QString& says) {
  if (!shown_) return;
  document_.change_placed(tr("Say what %1 feels like").arg(QString::fromStdString(row.name())), {*shown_},
                          [&](Placed& placed) {
                            for (wale::LaidOutMark& each : placed.patch.marks)
                              if (each.mark.slider == row.name()) each.mark.says = says.simplified().toStdString();
                          });
}

}  // namespace sandpaper
