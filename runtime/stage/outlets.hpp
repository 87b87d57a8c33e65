#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include "runtime/stage/latest.hpp"
#include "runtime/stage/placed_patches.hpp"
#include "wale/run.hpp"

namespace wale {

/// The state of a run after a tick, as the real-time thread stores it.
struct TickState {
  double time = 0;
  long ticks_run = 0, ticks_missed = 0;
  double lateness = 0;
  glm::vec2 position{0}, velocity{0};
  Force force{0};
  bool inside = false;
  std::uint32_t number = 0, generation = 0;  ///< of the patch, if the hand is inside
  std::uint32_t revision = 0;
  GuardCounts guards;
};

/// A contact as the real-time thread notes it.
struct NotedContact {
  ContactKind kind = ContactKind::enter;
  std::uint32_t number = 0, generation = 0;
  double time = 0;
  glm::vec2 position{0}, velocity{0};
  Force force{0};
};

/// A queue of fixed size from one thread to another. What does not fit is dropped and counted.
class ContactQueue {
 public:
  /// For the thread that serves the ticks. Real-time: allocates nothing, takes no lock, makes no system call.
  void push(const NotedContact& contact) noexcept {
    const std::uint64_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == places) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    contacts_[end % places] = contact;
    end_.store(end + 1, std::memory_order_release);
  }
  /// For one thread at a time. False if there is none.
  bool pop(NotedContact& contact) noexcept {
    const std::uint64_t begin = begin_.load(std::memory_order_relaxed);
    if (begin == end_.load(std::memory_order_acquire)) return false;
    contact = contacts_[begin % places];
    begin_.store(begin + 1, std::memory_order_release);
    return true;
  }
  /// From any thread: how many were dropped since the last call.
  std::uint64_t take_dropped() noexcept { return dropped_.exchange(0, std::memory_order_relaxed); }

 private:
  static constexpr std::uint64_t places = most_contacts_waiting;
  std::array<NotedContact, places> contacts_{};
  std::atomic<std::uint64_t> begin_ = 0, end_ = 0, dropped_ = 0;
};

/// A request for a copy of a patch's memory, which the real-time thread fills over one or several ticks.
struct MemoryRequest {
  MemoryRequest(std::uint32_t of_number, std::uint32_t of_generation, const Program& program)
      : number(of_number), generation(of_generation), copy(program) {}

  enum class Outcome { open, copied, absent, other_program };

  std::uint32_t number, generation;
  Memory copy;
  std::size_t cells_done = 0;
  std::uint32_t revision = 0;  ///< that the loop had
  std::atomic<Outcome> outcome = Outcome::open;
};

/// Where requests wait, one at a time.
class MemoryDesk {
 public:
  /// At most so many cells of grids are copied on one tick: some 10 us.
  static constexpr std::size_t cells_a_tick = 32768;

  void ask(MemoryRequest& request) noexcept { waiting_.store(&request, std::memory_order_release); }
  /// Takes back a request that is not being served at this moment. False if it is.
  bool take_back(MemoryRequest& request) noexcept {
    MemoryRequest* expected = &request;
    return waiting_.compare_exchange_strong(expected, nullptr, std::memory_order_acq_rel);
  }
  /// For the thread that serves the ticks. Real-time: allocates nothing, takes no lock, makes no system call.
  void serve(const PlacedPatches* patches) noexcept {
    if (waiting_.load(std::memory_order_relaxed) == nullptr) return;
    MemoryRequest* const request = waiting_.exchange(nullptr, std::memory_order_acquire);
    if (request == nullptr) return;
    using Outcome = MemoryRequest::Outcome;
    request->revision = patches != nullptr ? patches->revision : 0;
    const PlacedPatch* const patch = patches != nullptr ? patches->patch(request->number) : nullptr;
    Outcome outcome = Outcome::copied;
    if (patch == nullptr || patch->generation != request->generation) {
      outcome = Outcome::absent;
    } else if (&patch->memory->program().decoded() != &request->copy.program().decoded()) {
      outcome = Outcome::other_program;
    } else {
      request->cells_done += request->copy.copy_from(*patch->memory, request->cells_done, cells_a_tick);
      if (request->cells_done < patch->memory->cells().size()) {
        waiting_.store(request, std::memory_order_release);
        return;
      }
    }
    request->outcome.store(outcome, std::memory_order_release);  // the last that is done with it
  }

 private:
  std::atomic<MemoryRequest*> waiting_ = nullptr;
};

/// What the thread that serves the ticks gives to others.
struct Outlets {
  Latest<TickState> state;
  std::atomic<bool> wants_contacts = false;
  ContactQueue contacts;
  MemoryDesk desk;
};

}  // namespace wale
