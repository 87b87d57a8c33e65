#pragma once

#include "compiler/layout/ground.hpp"
#include "compiler/legibility/read_cues.hpp"

namespace wale {

/// How narrow a patch or a gap may be for one who moves as the hand `normal` does on a device.
class NarrowestFelt {
 public:
  /// The declarations must outlive it.
  NarrowestFelt(const Declarations& declarations, const DeviceProfile& device);

  /// Why something of a width, m, is too narrow.
  struct Reason {
    double needed = 0;  ///< m
    std::string why;    ///< "a period of its texture is 2.5 mm"
  };
  /// The strongest reason against a patch with these cues and this rim, m; its width is no matter.
  Reason for_patch(const Cues& cues, double rim) const;
  /// The same for a gap between two patches.
  Reason for_gap(const Cues& one, const Cues& other) const;

 private:
  Reason for_hand(double newton) const;

  const DeviceProfile& device_;
  double counts_ = 0;  ///< of the encoder: the fewest that are felt as they are
  double speed_ = 0;   ///< m/s
};

/// Warns of patches and gaps that are too small (W0435). A patch or gap that may be wide enough, within the squares of
/// the ground, is no matter.
void check_sizes(const std::vector<LaidPatch>& laid, const Ground& ground, const Declarations& declarations,
                 const DeviceProfile& device, ReadCues& cues, Diagnostics& diagnostics);

}  // namespace wale
