#include "runtime/record/event_reader.hpp"

#include "runtime/record/profile_program.hpp"
#include "runtime/shape/shape_bytes.hpp"
#include "schema/sentence.hpp"

namespace wale {

using namespace recording_format;

Result<> EventReader::read(const EventHeader& header, std::span<const std::byte> payload) {
  try {
    read_whole(header, payload);
    return {};
  } catch (const Error& error) {
    return error;
  }
}

void EventReader::read_whole(const EventHeader& header, std::span<const std::byte> payload) {
  const auto code = static_cast<EventCode>(header.kind);
  Bytes in("an event", payload);
  if ((code == EventCode::header) == has_header_)
    damaged("the header must be the first event, and the only one of its kind");
  if (contents_.said_ticks) damaged("it comes after the end event");
  if (code == EventCode::header) {
    read_header(in, payload);
  } else if (code == EventCode::program) {
    read_program(in, payload);
  } else if (code == EventCode::shape) {
    read_shape(in);
  } else {
    RecordedEvent event = read_event(code, in);
    event.ticks = header.ticks;
    in.finish();
    contents_.events.push_back(std::move(event));
  }
}

void EventReader::read_header(Bytes& in, std::span<const std::byte> payload) {
  RecordingHeader& header = contents_.header;
  header.most_newton = in.f64();
  if (!(header.most_newton > 0)) damaged("the largest force is ", header.most_newton, " N, expected more than 0");
  header.virtual_time = in.boolean("whether time is virtual");
  header.hand = in.text("the hand");
  const std::uint32_t size = in.u32();
  if (size != in.remaining()) damaged("the device's profile has ", in.remaining(), " bytes, expected ", size);
  Result<DeviceProfile> device = read_profile(payload.last(size));
  if (!device) throw std::move(device).error();
  header.device = *std::move(device);
  has_header_ = true;
}

void EventReader::read_program(Bytes& in, std::span<const std::byte> payload) {
  const std::uint64_t hash = in.u64();
  const auto bytes = payload.last(in.remaining());
  if (hash != hash_of(bytes)) damaged("the program's bytes do not match its hash");
  contents_.programs.push_back({hash, bytes});
}

void EventReader::read_shape(Bytes& in) {
  const ShapeFigures figures = wale::read_shape(in, most_mask_cells - mask_cells_);
  in.finish();
  if (const auto* mask = std::get_if<MaskFigures>(&figures)) mask_cells_ += mask->columns * mask->rows;
  auto shape = shape_of(figures);
  if (!shape) throw std::move(shape).error();
  contents_.shapes.push_back(*std::move(shape));
}

std::uint32_t EventReader::program(Bytes& in) const {
  const std::uint32_t number = in.u32();
  if (number >= contents_.programs.size()) damaged("program ", number, " has not been recorded");
  return number;
}

std::uint32_t EventReader::patch(Bytes& in) const {
  const std::uint32_t number = in.u32();
  if (number >= most_patches) damaged("patch ", number, " is beyond the greatest number, ", most_patches - 1);
  return number;
}

void EventReader::read_flags(std::uint32_t flags, RecordedEvent& event) {
  if (flags > (put_enabled | put_changed | put_renewed | put_sampled | put_shaped))
    damaged("the flags of a patch are ", flags);
  event.enabled = (flags & put_enabled) != 0;
  event.changed = (flags & put_changed) != 0;
  event.renewed = (flags & put_renewed) != 0;
  event.sampled = (flags & put_sampled) != 0;
}

RecordedEvent EventReader::read_event(EventCode code, Bytes& in) {
  RecordedEvent event;
  std::uint32_t flags = 0;
  const auto placement = [&] {
    event.program = program(in);
    for (int i = 0; i < 2; ++i) event.position[i] = in.f32();
    for (float* figure : {&event.size.width, &event.size.height, &event.size.rim}) *figure = in.f32();
  };
  switch (code) {
    case EventCode::place:
      event.kind = RecordedEvent::Kind::place;
      placement();
      return event;
    case EventCode::add:
      event.kind = RecordedEvent::Kind::add;
      placement();
      event.layer = in.f32();
      if (std::isnan(event.layer)) damaged("the layer is not a number");
      event.parameters.resize(in.count(sizeof(float), "parameters"));
      for (float& value : event.parameters) value = in.f32();
      return event;
    case EventCode::replace:
      event.kind = RecordedEvent::Kind::replace;
      event.patch = in.u32();
      event.program = program(in);
      return event;
    case EventCode::set:
      event.kind = RecordedEvent::Kind::set;
      event.patch = in.u32();
      event.parameter = in.u32();
      event.value = in.f32();
      return event;
    case EventCode::move:
      event.kind = RecordedEvent::Kind::move;
      event.patch = in.u32();
      for (int i = 0; i < 2; ++i) event.position[i] = in.f32();
      return event;
    case EventCode::put:
      event.kind = RecordedEvent::Kind::put;
      event.patch = patch(in);
      placement();
      event.layer = in.f32();
      if (!std::isfinite(event.layer)) damaged("the layer is not finite");
      event.order = in.u64();
      flags = in.u32();
      read_flags(flags, event);
      event.parameters.resize(in.count(sizeof(float), "parameters"));
      for (float& value : event.parameters) value = in.f32();
      if ((flags & put_shaped) != 0) {
        const std::uint32_t shape = in.u32();
        if (shape >= contents_.shapes.size()) damaged("shape ", shape, " has not been recorded");
        event.shape = contents_.shapes[shape];
      }
      return event;
    case EventCode::remove:
      event.kind = RecordedEvent::Kind::remove;
      event.patch = patch(in);
      return event;
    case EventCode::bound:
      event.kind = RecordedEvent::Kind::bound;
      event.patch = patch(in);
      event.sampled = in.boolean("whether the bound is sampled");
      return event;
    case EventCode::publish:
      event.kind = RecordedEvent::Kind::publish;
      event.revision = in.u32();
      if (event.revision != revision_ + 1) damaged("revision ", event.revision, " comes after revision ", revision_);
      revision_ = event.revision;
      return event;
    case EventCode::end:
      event.kind = RecordedEvent::Kind::end;
      contents_.said_ticks = in.u64();
      return event;
    case EventCode::header:
    case EventCode::program:
    case EventCode::shape: break;
  }
  damaged("its kind ", static_cast<std::uint32_t>(code), " is unknown");
}

}  // namespace wale
