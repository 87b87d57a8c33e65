#include "feeling/feeling.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sandpaper {
namespace {

constexpr double usual_rim = 0.001;   // m
constexpr double widest_rim = 0.25;   // of the shorter side
constexpr int urgent = 10;            // what lies on the workspace, before thumbnails

QString words_of(const wale::Error& error) { return QString::fromStdString(wale::in_words(error)); }

}  // namespace

Feeling::Feeling(const wale::Library& library, Programs& programs, QObject* parent)
    : QObject(parent), library_(library), programs_(programs) {
  connect(&programs_, &Programs::compiled, this, &Feeling::follow_programs);
  open("mouse");
}

Feeling::~Feeling() {
  if (opening_.joinable()) opening_.join();
  stage_.reset();
}

std::vector<std::pair<QString, QString>> Feeling::choices() const {
  std::vector<std::pair<QString, QString>> choices = {{"mouse", tr("the mouse (force is shown)")}};
  const auto trusted = library_.trusted_devices();
  for (const wale::DeviceInfo& each : wale::devices(trusted ? *trusted : wale::TrustedDevices())) {
    if (each.kind == wale::DeviceKind::pointer) continue;
    QString name = QString::fromStdString(each.name.empty() ? each.spelling : each.name);
    if (each.kind == wale::DeviceKind::simulated) name = tr("%1, simulated").arg(name);
    if (each.obstacle) name += " — " + QString::fromStdString(each.obstacle->sentence);
    choices.emplace_back(QString::fromStdString(each.spelling), name);
  }
  return choices;
}

void Feeling::open(const QString& spelling) {
  set_on(false);
  const std::uint64_t attempt = ++attempt_;
  if (spelling == "mouse") {
    wale::DeviceProfile profile;
    for (const wale::DeclaredDevice& each : library_.devices())
      if (each.profile.name == wale::default_device) profile = each.profile;
    take(spelling, std::unique_ptr<wale::Device>(std::make_unique<MouseHand>(profile)), attempt);
    return;
  }
  if (opening_.joinable()) opening_.join();
  emit said(tr("Opening %1 …").arg(spelling));
  opening_ = std::thread([this, spelling, attempt] {
    auto device = std::make_shared<wale::Result<std::unique_ptr<wale::Device>>>(
        library_.open_device(spelling.toStdString(), {.ask = [this](const std::string& what) {
          window_.post([this, what] { emit said(QString::fromStdString(what)); });
        }}));
    window_.post([this, spelling, device, attempt] { take(spelling, std::move(*device), attempt); });
  });
}

void Feeling::take(QString spelling, wale::Result<std::unique_ptr<wale::Device>> device, std::uint64_t attempt) {
  if (attempt != attempt_) return;
  if (!device) {
    emit said(tr("%1 cannot be opened: %2").arg(spelling, words_of(device.error())));
    emit device_changed();
    return;
  }
  stage_.reset();
  mouse_ = dynamic_cast<MouseHand*>(device->get());
  device_ = std::make_unique<Recentred>(*std::move(device));
  heard_device_ = std::make_unique<HeardDevice>(*device_, heard_);
  spelling_ = std::move(spelling);
  profile_ = device_->profile();
  if (max_force_ <= 0 || max_force_ > profile_.force_newton) max_force_ = profile_.force_newton;
  programs_.set_device(profile_.name);
  renew_stage();
  emit device_changed();
}

void Feeling::set_max_force(double newton) {
  const double most = profile_.force_newton > 0 ? profile_.force_newton : newton;
  const double wanted = std::clamp(newton, 0.01, std::max(most, 0.01));
  if (wanted == max_force_) return;
  const bool was_on = on_;
  set_on(false);
  max_force_ = wanted;
  renew_stage();
  set_on(was_on);
}

void Feeling::set_on(bool on) {
  if (on == on_ || !stage_) return;
  QString problem;
  if (on) {
    if (const auto begun = stage_->start(); !begun) {
      emit said(tr("Nothing can be felt: %1").arg(words_of(begun.error())));
      if (is_recording()) end_recording(words_of(begun.error()));  // the next time one feels without it
      return;
    }
  } else if (const auto ended = stage_->stop(); !ended) {
    problem = words_of(ended.error());
    emit said(problem);
  }
  on_ = on;
  if (on) emit forgot();
  if (!on && is_recording()) end_recording(problem);
  emit on_changed();
}

void Feeling::end_recording(const QString& problem) {
  const QString file = std::exchange(record_, {});
  renew_stage();  // a stage that records has one run
  emit recorded(file, problem);
}

void Feeling::record(const QString& file) {
  set_on(false);
  record_ = file;
  renew_stage();
}

void Feeling::renew_stage() {
  stage_.reset();
  by_patch_.clear();
  // As `wale feel` asks for: what the window draws must not make the loop late.
  wale::StageOptions options{.priority = wale::usual_priority, .lock_memory = true, .low_latency = true};
  if (profile_.force_newton > 0) options.max_force = max_force_;
  if (is_recording()) options.record = wale::RecordTo{.file = record_.toStdString(), .hand = {}};
  stage_ = std::make_unique<wale::Stage>(*heard_device_, options);
  for (auto& [id, felt] : felt_) felt.patch.reset(), felt.program.reset(), felt.material.reset();
  follow(Contents(contents_));
}

wale::PatchSize felt_size(const wale::LaidOutPatch& patch, const wale::Program& program) {
  wale::PatchSize size = program.default_size();
  if (patch.size) size.width = static_cast<float>(patch.size->x), size.height = static_cast<float>(patch.size->y);
  else if (!patch.outline.is_rectangle() && patch.shape != "ellipse")
    size.width = patch.outline.size().x, size.height = patch.outline.size().y;
  size.rim =
      static_cast<float>(patch.rim.value_or(std::min(usual_rim, widest_rim * std::min(size.width, size.height))));
  return size;
}

wale::PatchOptions Feeling::options(const Felt& felt) const {
  const wale::LaidOutPatch& patch = felt.placed->patch;
  const wale::PatchSize size = felt_size(patch, *felt.program);
  return {.at = glm::vec2(patch.at), .size = size, .layer = static_cast<float>(felt.layer), .shape = patch.outline};
}

void Feeling::place(Felt& felt) {
  if (!felt.program || felt.patch || felt.placed->away) return;
  auto patch = stage_->add(*felt.program, options(felt));
  if (!patch) {
    emit said(
        tr("%1 cannot be felt: %2").arg(QString::fromStdString(felt.placed->patch.name), words_of(patch.error())));
    return;
  }
  felt.patch = *patch;
  by_patch_[patch->id()] = felt.placed->id;
  for (const auto& [name, value] : felt.placed->sliders) (void)felt.patch->set(name, value);
}

void Feeling::update(Felt& felt, const PlacedRef& placed, std::size_t layer) {
  const PlacedRef before = std::exchange(felt.placed, placed);
  const std::size_t layer_before = std::exchange(felt.layer, layer);
  const wale::LaidOutPatch &old = before->patch, &now = placed->patch;
  if (before == placed && layer == layer_before) return;
  if (felt.patch && (placed->away || !(old.outline == now.outline))) {  // a shape is part of a patch for good
    by_patch_.erase(felt.patch->id());
    (void)felt.patch->remove();
    felt.patch.reset();
    place(felt);
    return;
  }
  if (!felt.patch) return;
  if (old.at != now.at) (void)felt.patch->move(glm::vec2(now.at));
  if (old.size != now.size || old.rim != now.rim) (void)felt.patch->resize(*options(felt).size);
  if (layer != layer_before) (void)felt.patch->bring({static_cast<float>(layer)});
  if (placed->sliders != before->sliders) {
    for (const auto& [name, value] : placed->sliders) (void)felt.patch->set(name, value);
    for (const auto& [name, value] : before->sliders)
      if (!placed->sliders.contains(name))
        for (const wale::Parameter& each : felt.program->description().parameters)
          if (each.name == name) (void)felt.patch->set(name, each.value);
  }
}

void Feeling::follow(const Contents& contents) {
  contents_ = contents;
  std::map<std::uint64_t, Felt> next;
  for (std::size_t i = 0; i < contents.placed.size(); ++i) {
    const PlacedRef& placed = contents.placed[i];
    if (!placed->is_laid_out()) continue;
    const auto known = felt_.find(placed->id);
    if (known == felt_.end()) {
      next[placed->id] = {.placed = placed, .layer = i};
    } else {
      update(known->second, placed, i);
      next[placed->id] = std::move(known->second);
      felt_.erase(known);
    }
  }
  for (auto& [id, gone] : felt_)
    if (gone.patch) {
      by_patch_.erase(gone.patch->id());
      (void)gone.patch->remove();
    }
  felt_ = std::move(next);
  follow_programs();
}

void Feeling::follow_programs() {
  if (!stage_) return;
  const std::string surroundings = contents_.surroundings();
  bool changed = false;
  std::map<std::string, MaterialProgramRef> found;  // one look-up for each material
  for (auto& [id, felt] : felt_) {
    const std::string& made_of = felt.placed->compiled_from;
    const auto [entry, is_new] = found.try_emplace(made_of);
    if (is_new) entry->second = programs_.find(surroundings, contents_.file, made_of, urgent);
    const MaterialProgramRef& material = entry->second;
    if (!material || material == felt.material) {
      place(felt);
      continue;
    }
    felt.material = material;
    changed = true;
    if (!material->program) continue;  // the last good one stays felt
    felt.program = material->program;
    if (felt.patch) (void)felt.patch->replace(*felt.program);
    else place(felt);
  }
  if (changed) emit programs_changed();
}

void Feeling::set(std::uint64_t id, const std::string& parameter, float value) {
  const auto found = felt_.find(id);
  if (found != felt_.end() && found->second.patch) (void)found->second.patch->set(parameter, value);
}

void Feeling::move_mouse(glm::vec2 to, bool pressed) {
  if (!mouse_) return;
  mouse_->move(to);
  mouse_->press(pressed);
}

bool Feeling::recentre() {
  if (is_mouse()) {
    emit said(tr("The mouse is where it is seen: it has no other centre. Choose a device first"));
    return false;
  }
  set_on(false);
  if (!device_ || profile_.position_counts <= 0) {
    emit said(tr("This device has no position"));
    return false;
  }
  // No loop runs, so the device is this thread's.
  device_->elapse(1);
  const wale::Reading reading = device_->device().sample();
  if (reading.contact != wale::Contact::good) {
    emit said(tr("The device does not say where its handle is: move it a little, and try again"));
    return false;
  }
  device_->move_centre(reading.counts);
  return true;
}

bool Feeling::centre_back() {
  if (!device_ || device_->centre() == glm::ivec2(0)) return false;
  set_on(false);
  device_->move_centre({0, 0});
  return true;
}

glm::dvec2 Feeling::centre() const {
  return device_ ? glm::dvec2(device_->centre()) * glm::dvec2(profile_.position_step()) : glm::dvec2(0);
}

wale::Now Feeling::now() const { return stage_ ? stage_->now() : wale::Now{}; }

std::optional<std::uint64_t> Feeling::touched(const wale::Now& now) const {
  if (!on_ || !now.patch) return std::nullopt;
  const auto found = by_patch_.find(now.patch->id());
  return found == by_patch_.end() ? std::nullopt : std::optional(found->second);
}

const wale::Program* Feeling::program(std::uint64_t id) const {
  const auto found = felt_.find(id);
  return found != felt_.end() && found->second.program ? &*found->second.program : nullptr;
}

MaterialProgramRef Feeling::material(std::uint64_t id) const {
  const auto found = felt_.find(id);
  return found == felt_.end() ? nullptr : found->second.material;
}

std::optional<wale::Snapshot> Feeling::snapshot(std::uint64_t id) const {
  const auto found = felt_.find(id);
  if (found == felt_.end() || !found->second.patch) return std::nullopt;
  auto snapshot = found->second.patch->snapshot();
  return snapshot ? std::optional(*std::move(snapshot)) : std::nullopt;
}

float Feeling::value(const Placed& placed, const wale::Parameter& parameter) const {
  const auto found = placed.sliders.find(parameter.name);
  return found == placed.sliders.end() ? parameter.value : found->second;
}

}  // namespace sandpaper
