// SPDX-License-Identifier: Apache-2.0
// A live scan: views as a sensor gives them, a preview of the surface all the while, and at the end, or
// whenever it is asked for, the global cut of all of them.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vdbfuse/pipeline/integrator.h"
#include "vdbfuse/pipeline/reconstruct.h"
#include "vdbfuse/sensor/view_sequence.h"

namespace vdbfuse {

/// What push() does with a view when the queue is full.
enum class WhenFull {
  /// The view that has waited longest goes. A sensor is never held up, and what the preview shows is never
  /// older than the queue is long.
  DropOldest,
  DropNewest,  ///< the view that comes goes; what was accepted stays
  Wait,        ///< push() waits: nothing is lost. For recordings, which can wait
};

struct ScannerOptions {
  /// The preview: its voxel (> 0), truncation, noise of the sensor, colours. No carving: views could not be
  /// taken out any more.
  IntegratorOptions preview;
  /// Depths outside [near, far], in the sensor's measure, are not looked at, neither by the preview nor by
  /// finish(). Beyond their range sensors report little that is right, and it costs time.
  double near = 0.0, far = std::numeric_limits<double>::infinity();
  /// Views that may wait, > 0. With DropOldest the preview lags this many frames behind at most.
  std::size_t queue_capacity = 8;
  WhenFull when_full = WhenFull::DropOldest;
  /// Bytes of views that are kept in memory; those that come later lie in a file without a name in $TMPDIR or
  /// /var/tmp. A view of quantised depths takes 2 bytes a pixel (0.6 MB at 640×480), any other 4; confidences
  /// and alternatives 4, colours 3, masks 1 more.
  std::size_t memory = std::size_t{1} << 30;
};

/// Everything that is wrong with the options, one sentence each.
std::vector<std::string> validate(const ScannerOptions& options);

/// Names a view: 1, 2, 3, … in the order of push().
using ViewId = std::uint64_t;

struct PoseCorrection {
  ViewId view = 0;
  RigidTransform world_from_camera = RigidTransform::Identity();
};

/// What changed of the preview since the one before.
struct ScannerPreview {
  std::vector<SurfaceBlock> changed;  ///< new blocks and new contents of old ones, never empty
  std::vector<Index3> removed;        ///< origins of blocks that have no surface any more
  ViewId newest = 0;                  ///< the latest view that is part of it; 0: none
};

struct ScannerStatus {
  std::size_t pushed = 0;       ///< views that push() was called with
  std::size_t integrated = 0;   ///< of them, worked into the preview, whether they were removed later or not
  std::size_t dropped = 0;      ///< of them, lost because the queue was full
  std::size_t waiting = 0;      ///< in the queue, or being worked on
  std::size_t corrections = 0;  ///< poses and removals that wait to be worked in
  std::size_t kept = 0;         ///< views that finish() would use
  std::size_t kept_bytes = 0;   ///< of them, in memory and in the file
  std::size_t preview_bytes = 0;
};

/// Which views are enough: one is left out while its sensor has moved no further than `distance` and turned
/// by no more than `angle` since the last one that was not. 0 and 0: every view is used.
struct KeyViews {
  double distance = 0.0;  ///< unit of the poses
  double angle = 0.0;     ///< radians
};

struct FinishOptions {
  ReconstructOptions reconstruct;
  /// At 30 views a second most show what their neighbours show, and the cut takes time for each.
  KeyViews key_views;
  enum class Colors {
    Drop,
    Keep
  } colors = Colors::Drop;  ///< Keep: colorReconstruction() with the same views
};

/// All methods may be called from any thread at any time; only the destructor must be the last call.
/// A thread of the scanner's own integrates views in the order of push() and works corrections in between
/// them; the loops inside both, of previews and of finish(), share the processors. What went wrong on that
/// thread (a full disk, no memory) is thrown once by the next call of any method but status() and views();
/// the view it happened with is lost, the others are not.
class Scanner {
 public:
  /// Throws InvalidArgument.
  explicit Scanner(const ScannerOptions& options);
  /// What still waits is dropped.
  ~Scanner();

  /// Takes a view: returns at once, except with WhenFull::Wait. Nothing where it was dropped for being the
  /// newest. Throws InvalidArgument when validate(view) objects.
  std::optional<ViewId> push(View view);

  /// Takes a view out again, of the preview and of what finish() uses. Returns at once; views that were
  /// dropped or removed already are passed over. Throws InvalidArgument for a number that push() never gave.
  void remove(ViewId view);
  /// Better poses, as a loop closure gives them for many views at once. Returns at once: each view leaves the
  /// preview at its old pose and enters at the new one, one after the other, when no view waits, and after
  /// every second view at the latest. Of two corrections of a view the later one counts. As remove()
  /// otherwise.
  void correctPoses(std::span<const PoseCorrection> corrections);
  void correctPose(ViewId view, const RigidTransform& world_from_camera) {
    const PoseCorrection correction{view, world_from_camera};
    correctPoses({&correction, 1});
  }

  /// Waits until the views pushed before the call are part of the preview, and no correction waits. Throws
  /// Cancelled.
  void wait(const Progress& progress = {});

  /// What changed since the last call, whoever made it: for one viewer. Costs what changed; does not wait for
  /// views in the queue.
  ScannerPreview preview();
  /// The whole preview as one mesh: Integrator::mesh(). Costs more; independent of preview().
  TriangleMesh mesh();
  ScannerStatus status() const;

  /// The views that are kept, at their poses of now, as push() got them but for what near and far cut away.
  /// What was integrated; corrections that wait are not part of it. May outlive the scanner.
  ViewSequence views(const KeyViews& key_views = {}) const;
  /// wait(), then reconstruct() of views(): the same mesh to the last bit. The scan may go on meanwhile and
  /// afterwards. Throws what reconstruct() throws.
  Reconstruction finish(const FinishOptions& options = {}, const Progress& progress = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vdbfuse
