#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "runtime/record/record_writer.hpp"
#include "runtime/stage/bank_cache.hpp"
#include "runtime/stage/exchange.hpp"
#include "runtime/stage/placed_patches.hpp"
#include "runtime/stage/wanted_patch.hpp"

namespace wale {

/// What a handle names: a slot, and which of the patches that were in it one after the other.
struct PatchName {
  std::uint32_t number = 0, generation = 0;
  friend bool operator==(const PatchName&, const PatchName&) = default;
};

/// The patches of a stage as their callers want them, and what of it the loop has. The control side's; whoever calls
/// holds the stage's mutex. Numbers of removed patches are used again.
///
/// During a run each change is published as soon as it can be: places, layers, enabling and removing at once; a
/// program, parameters or a size when their bank is prepared. Until then the patch keeps its old bank, and a new patch
/// is not felt. A bank that is begun is published although a newer one is wanted meanwhile, so each of an endless
/// stream of changes replaces only what nobody has begun. Changes of one edit are published together, when all are
/// ready. A later edit of one of its patches waits until then as a whole, so an endless stream of edits is felt too.
class PatchTable {
 public:
  /// How banks are prepared during a run.
  enum class Manner {
    together,   ///< by `publish`, all at once with their sampled ranges: virtual time and replay, the same bits each
                ///< time
    piecewise,  ///< by another thread, in the order that `next_work` gives
  };

  explicit PatchTable(BankCache& banks) : banks_(banks) {}

  /// A name for a patch that is wanted later. Nobody else gets it until it is released.
  PatchName reserve();
  void release(PatchName name);
  /// Whether it is a name for a patch that is wanted later.
  bool is_reserved(PatchName name) const;
  /// The patch as it is wanted, or null if there is none.
  const WantedPatch* wanted(PatchName name) const;
  std::size_t size() const { return count_; }
  std::uint64_t next_order() { return ++order_; }

  /// What becomes of a patch; nothing removes it.
  using Wish = std::pair<PatchName, std::optional<WantedPatch>>;
  /// All or nothing is felt at one tick. The names are reserved or have patches, each at most once. Throws
  /// std::bad_alloc; then nothing has changed.
  void want(std::vector<Wish> wishes);

  /// Begins a run, with banks and memories of its own for all patches.
  void begin(Manner manner, bool lock_memory = false);
  void end() noexcept;
  /// Whether `publish` has something to do.
  bool has_news() const { return !dirty_.empty(); }
  /// Hands over what is ready as the next revision, if anything has changed, and records it.
  void publish(Exchange<PlacedPatches>& patches, RecordWriter* recorder);
  std::uint32_t revision() const { return revision_; }
  /// Whether a patch waits for its bank.
  bool is_waiting() const { return !jobs_.empty(); }

  /// Where the hand is, for the order of the work.
  struct Nearby {
    glm::vec2 position{0}, velocity{0};  ///< m, m/s
  };
  /// Something to do without the mutex.
  struct Work {
    enum class Kind { bank, base, range } kind = Kind::bank;
    std::optional<BankKey> key = {};                ///< of a bank
    Arrangement::Outlines outlines = {};            ///< of a base
    std::shared_ptr<const PreparedBank> bank = {};  ///< whose range is to be sampled; of a bank: the result
    std::shared_ptr<const FrontMost> base = {};     ///< the result
    bool may_stop = true;                           ///< it has not been waiting for long

    /// Does it. False if `stop` ended it.
    bool run(BankCache& banks, const std::atomic<bool>& stop);
  };
  /// The next work, if there is any: the bank of the patch under the hand, or of the one that it will reach first; then
  /// a new base; then ranges. When these have waited for many banks, one of them comes first.
  std::optional<Work> next_work(const Nearby& hand);
  void finish(Work work, bool done);
  /// Ends the work on a range early, since a bank is wanted.
  const std::atomic<bool>& hurry() const { return hurry_; }

  /// The memory of a patch in the present run or the last one, and its bank; empty where it has none.
  struct Felt {
    std::shared_ptr<Memory> memory;
    std::shared_ptr<const PreparedBank> bank;
    bool is_placed = false;       ///< the loop may use the memory
    std::uint32_t withdrawn = 0;  ///< otherwise: since this revision it does not
    const WantedPatch* as = nullptr;  ///< as it was published in that run; null where it was not; the table's
    const WantedPatch* before = nullptr;  ///< as the run before had it last; null where none had it; the table's
  };
  Felt felt(PatchName name) const;
  /// A patch as it was published last.
  struct Published {
    PatchName name;
    BankKey key;
    std::uint64_t change = 0;  ///< as in `PlacedPatch`
  };
  /// Those patches that are wanted, were published in the present run, and had one of these numbers of a change then.
  std::vector<Published> published(const std::unordered_set<std::uint32_t>& changes) const;

  /// For replay: the patch counts as changed although it may be the same; with `renew` it gets a new memory that
  /// succeeds the old one; with `loose` it has the trivial bound.
  void touch(PatchName name, bool renew);
  void loosen(PatchName name, bool loose);

 private:
  /// A patch that waited for a bank when it was begun, and now wants another one.
  struct Overtaken {
    PatchName name;
    std::uint64_t version = 0;  // of the patch's bank
  };
  struct Job {
    std::vector<std::uint32_t> slots;  // that wait for it
    std::vector<Overtaken> overtaken;
    bool begun = false;
  };
  using Jobs = std::unordered_map<BankKey, Job, BankKeyHash>;

  /// A prepared bank that is older than what is wanted, and newer than what is felt.
  struct Older {
    BankKey key;
    std::shared_ptr<const PreparedBank> bank;
    std::uint64_t version = 0;
  };

  struct Slot {
    std::uint32_t generation = 0;
    bool taken = false;  // reserved, wanted, or not yet let go by the loop
    bool reserved = false;
    bool dirty = false;
    bool touched = false, renewed = false, loose = false;
    std::uint32_t edit = 0;                         // of the edit that it waits with; 0: none
    std::optional<std::optional<WantedPatch>> later;  // becomes `wanted` when its edit is published
    Jobs::value_type* job = nullptr;                // that it waits for
    std::optional<WantedPatch> wanted;
    std::shared_ptr<const PreparedBank> ready;  // the bank of `wanted`, when it is known
    std::optional<Older> older;                 // otherwise
    std::uint64_t version = 0;                  // of the wanted bank: how many there were
    std::uint64_t felt_version = 0;             // of the published bank
    std::uint64_t edit_version = 0;             // the oldest that is good enough for `edit`
    std::uint64_t since = 0;        // when it began to wait for a bank, in the order of waiting; 0: it does not
    bool is_unsampled = false;      // in `unsampled_`
    bool is_replaced = false;       // in `replaced_`
    std::optional<WantedPatch> felt;  // as published; its program, parameters and size may be older
    std::optional<WantedPatch> felt_before;  // at the end of an earlier run
    std::shared_ptr<const PreparedBank> bank;  // as published
    std::shared_ptr<Memory> memory;
    bool sampled = false;    // the published bound is the sampled one
    Shape shape, stretched;  // as placed, and to the published size
    std::uint64_t change = 0;
    std::uint32_t withdrawn = 0;
  };

  Slot* find(PatchName name);
  const Slot* find(PatchName name) const;
  void mark(std::uint32_t number);
  /// What a wish needs that takes memory, made before anything changes.
  struct Prepared {
    bool other_bank = false;
    std::optional<BankKey> older;               // the key of the bank that is ready and not felt yet
    std::shared_ptr<const PreparedBank> ready;  // the wanted bank, if it is known
    Jobs::value_type* job = nullptr;            // otherwise the one that the slot will wait for
  };
  std::vector<Prepared> prepare(const std::vector<Wish>& wishes);
  /// Forgets jobs for which no slot waits.
  void forget_idle_jobs() noexcept;
  /// Makes the wishes those that are published next. Throws std::bad_alloc; then nothing has changed.
  void take_wishes(std::vector<Wish>& wishes);
  /// The patch of a slot is not wanted any more. True if the loop may have it.
  bool drop(std::uint32_t number) noexcept;
  void take_later_wishes();
  void take_later_wishes_at_rest() noexcept;
  void request(std::uint32_t number, Prepared prepared) noexcept;
  void withdraw_request(Slot& slot, std::uint32_t number);
  /// For the patch's edit.
  bool is_ready(const Slot& slot) const {
    return !slot.wanted || slot.ready || (slot.older && slot.older->version >= slot.edit_version);
  }
  /// Marks the patches of an edit if all are ready.
  void settle(std::uint32_t edit);
  bool waits_for_its_edit(const Slot& slot) const { return slot.edit != 0 && !edits_.at(slot.edit).settled; }
  /// Forgets the edits that were published with these patches.
  void end_edits(const std::vector<std::uint32_t>& numbers);
  /// A bank is prepared that was wanted when it was begun.
  void take_older(const Overtaken& overtaken, const Work& work);
  std::optional<Work> next_range(const Nearby& hand, bool longest_first);
  void free_slot(std::uint32_t number);
  bool changes_outline(const Slot& slot) const;
  bool publish_slot(std::uint32_t number, RecordWriter* recorder);
  /// Arranges the patch, now as `next` says.
  void arrange(std::uint32_t number, const WantedPatch& next, const std::shared_ptr<const PreparedBank>& bank,
               bool sampled);
  void record(const Slot& slot, std::uint32_t number, const WantedPatch& next, bool changed, bool renewed, bool sampled,
              RecordWriter& recorder) const;

  BankCache& banks_;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_;
  std::size_t count_ = 0;
  std::uint64_t order_ = 0, changes_ = 0, waits_ = 0;
  bool running_ = false;
  Manner manner_ = Manner::together;
  bool lock_memory_ = false;
  std::vector<std::uint32_t> dirty_;
  std::vector<std::uint32_t> replaced_;   // whose memories may have predecessors
  std::vector<std::uint32_t> unsampled_;  // published with the trivial bound
  Jobs jobs_;
  struct Edit {
    std::vector<std::uint32_t> slots;
    bool settled = false;  // all are ready, and the next `publish` has them
  };
  std::map<std::uint32_t, Edit> edits_;  // that are not published
  std::vector<std::uint32_t> later_;     // the slots with later wishes; all these are felt together
  std::uint32_t last_edit_ = 0;
  std::uint32_t revision_ = 0;
  bool base_under_way_ = false;
  int banks_before_others_ = 0;  // that were begun while a base or a range was waiting
  std::atomic<bool> hurry_ = false;
  Arrangement arrangement_;
};

}  // namespace wale
