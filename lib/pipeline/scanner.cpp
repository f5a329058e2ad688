// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/pipeline/scanner.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include "pipeline/kept_views.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

// Corrections have to wait for this many views at most, so that the sensor is kept up with first.
constexpr int kViewsPerCorrection = 2;
constexpr std::chrono::milliseconds kReportEvery{50};

using Corrections = std::map<ViewId, std::optional<RigidTransform>>;  // no pose: the view goes

const ScannerOptions& checked(const ScannerOptions& options) {
  const std::vector<std::string> problems = validate(options);
  if (!problems.empty()) throw InvalidArgument("options", problems.front());
  return options;
}

// As ViewSequence::load() gives it to reconstruct().
void prepare(const ScannerOptions& options, View& view) {
  normaliseInvalid(view.map.depth);
  const std::vector<std::string> problems = validate(view);
  if (!problems.empty()) throw InvalidArgument("view '" + view.name + "'", problems.front());
  applyMask(view.map);
  for (float& depth : view.map.depth)
    if (depth < options.near || depth > options.far) depth = kInvalidDepth;
}

void checkPose(const RigidTransform& pose) {
  if (!pose.matrix().allFinite() || rotationError(pose.linear()) > kRotationTolerance)
    throw InvalidArgument("world_from_camera", "is not a rotation and a translation");
}

}  // namespace

std::vector<std::string> validate(const ScannerOptions& options) {
  std::vector<std::string> problems = validate(options.preview);
  if (options.preview.carving == IntegratorOptions::Carving::On)
    problems.emplace_back("preview.carving must be off: views could not be taken out again");
  if (!(options.near >= 0 && options.far > options.near))
    problems.emplace_back("near must not be negative, and far must lie beyond it");
  if (options.queue_capacity == 0) problems.emplace_back("queue_capacity must be positive");
  return problems;
}

struct Scanner::Impl {
  explicit Impl(const ScannerOptions& scanner_options)
      : options(checked(scanner_options)),
        integrator(options.preview),
        kept(options.memory),
        worker([this] { work(); }) {}

  ~Impl() {
    {
      const std::lock_guard lock(mutex);
      stops = true;
    }
    changed.notify_all();
    worker.join();
  }

  struct Waiting {
    ViewId id;
    View view;
  };

  const ScannerOptions options;
  Integrator integrator;
  std::mutex preview_mutex;  ///< one preview() after the other; taken before `mutex`

  mutable std::mutex mutex;  ///< guards what follows
  std::condition_variable changed;
  bool stops = false;
  std::exception_ptr failure;
  std::deque<Waiting> queue;
  ViewId working_on = 0;  ///< 0: nothing
  Corrections corrections;
  int views_since_correction = 0;
  ViewId last_id = 0, newest = 0;
  std::size_t pushed = 0, integrated = 0, dropped = 0;
  KeptViews kept;

  std::thread worker;  ///< last: everything else is there when it starts

  // REQUIRES of all that follow: `mutex` is held, but where it says otherwise.

  void throwFailure() {
    if (failure) std::rethrow_exception(std::exchange(failure, nullptr));
  }

  void checkId(ViewId id) const {
    if (id == 0 || id > last_id)
      throw InvalidArgument("view", "there is none with number " + std::to_string(id));
  }

  bool makeRoom(std::unique_lock<std::mutex>& lock) {
    if (options.when_full == WhenFull::Wait)
      changed.wait(lock, [&] { return queue.size() < options.queue_capacity; });
    if (queue.size() < options.queue_capacity) return true;
    ++dropped;
    if (options.when_full == WhenFull::DropNewest) return false;
    queue.pop_front();
    return true;
  }

  // Where a view is decides what a correction means for it.
  void correct(ViewId id, const std::optional<RigidTransform>& pose) {
    const auto waiting =
        std::find_if(queue.begin(), queue.end(), [&](const Waiting& entry) { return entry.id == id; });
    if (waiting != queue.end()) {
      if (pose) return moveTo(*pose, waiting->view);
      queue.erase(waiting);
    } else if (id == working_on || kept.find(id) != nullptr) {
      if (const auto old = corrections.find(id); old != corrections.end() && !old->second) return;
      corrections[id] = pose;
    }
  }

  bool isIdle(ViewId last) const {
    return corrections.empty() && (working_on == 0 || working_on > last) &&
           (queue.empty() || queue.front().id > last);
  }

  // On the worker's thread, without the mutex.
  void work() {
    std::unique_lock lock(mutex);
    while (true) {
      changed.wait(lock, [&] { return stops || !queue.empty() || !corrections.empty(); });
      if (stops) return;
      const bool correction_is_due = queue.empty() || views_since_correction >= kViewsPerCorrection;
      try {
        if (!corrections.empty() && correction_is_due) {
          workCorrectionIn(lock);
        } else {
          workViewIn(lock);
        }
      } catch (...) {
        if (!lock.owns_lock()) lock.lock();
        failure = std::current_exception();
        if (kept.find(working_on) != nullptr) kept.erase(working_on);
      }
      working_on = 0;
      changed.notify_all();
    }
  }

  // Lets go of the mutex meanwhile.
  void workViewIn(std::unique_lock<std::mutex>& lock) {
    Waiting next = std::move(queue.front());
    queue.pop_front();
    working_on = next.id;
    ++views_since_correction;
    const auto memory = kept.nextMemory();
    lock.unlock();
    changed.notify_all();  // there is room in the queue
    KeptView done{next.view, std::make_shared<const PackedImages>(next.view.map, memory)};
    integrator.integrate(next.view);
    lock.lock();
    kept.insert(next.id, std::move(done));
    newest = next.id;
    ++integrated;
  }

  // Lets go of the mutex meanwhile.
  void workCorrectionIn(std::unique_lock<std::mutex>& lock) {
    const auto [id, pose] = *corrections.begin();
    corrections.erase(corrections.begin());
    working_on = id;
    views_since_correction = 0;
    const KeptView* found = kept.find(id);
    if (found == nullptr) return;  // it went wrong while it was integrated
    const KeptView old = *found;
    lock.unlock();
    View view = old.unpack();
    integrator.remove(view);
    if (pose) {
      moveTo(*pose, view);
      integrator.integrate(view);
    }
    lock.lock();
    if (pose) {
      kept.at(id).header = view;
    } else {
      kept.erase(id);
    }
  }
};

Scanner::Scanner(const ScannerOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Scanner::~Scanner() = default;

std::optional<ViewId> Scanner::push(View view) {
  prepare(impl_->options, view);
  std::unique_lock lock(impl_->mutex);
  impl_->throwFailure();
  ++impl_->pushed;
  if (!impl_->makeRoom(lock)) return std::nullopt;
  const ViewId id = ++impl_->last_id;
  if (view.name.empty()) view.name = "view " + std::to_string(id);
  impl_->queue.push_back({id, std::move(view)});
  impl_->changed.notify_all();
  return id;
}

void Scanner::remove(ViewId view) {
  const std::lock_guard lock(impl_->mutex);
  impl_->throwFailure();
  impl_->checkId(view);
  impl_->correct(view, std::nullopt);
  impl_->changed.notify_all();
}

void Scanner::correctPoses(std::span<const PoseCorrection> corrections) {
  const std::lock_guard lock(impl_->mutex);
  impl_->throwFailure();
  for (const PoseCorrection& correction : corrections)
    impl_->checkId(correction.view), checkPose(correction.world_from_camera);
  for (const PoseCorrection& correction : corrections)
    impl_->correct(correction.view, correction.world_from_camera);
  impl_->changed.notify_all();
}

void Scanner::wait(const Progress& progress) {
  std::unique_lock lock(impl_->mutex);
  const ViewId last = impl_->last_id;
  const std::size_t all = impl_->queue.size() + impl_->corrections.size() + 1;
  while (
      !impl_->changed.wait_for(lock, kReportEvery, [&] { return impl_->isIdle(last) || impl_->failure; })) {
    const std::size_t left = std::min(all, impl_->queue.size() + impl_->corrections.size() + 1);
    lock.unlock();
    progress.report("wait", 1 - static_cast<double>(left) / static_cast<double>(all));
    lock.lock();
  }
  impl_->throwFailure();
}

ScannerPreview Scanner::preview() {
  const std::lock_guard one_after_the_other(impl_->preview_mutex);
  ScannerPreview preview;
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->throwFailure();
    preview.newest = impl_->newest;
  }
  for (SurfaceBlock& block : impl_->integrator.changedBlocks()) {
    if (block.mesh.triangles.empty()) {
      preview.removed.push_back(block.origin);
    } else {
      preview.changed.push_back(std::move(block));
    }
  }
  return preview;
}

TriangleMesh Scanner::mesh() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->throwFailure();
  }
  return impl_->integrator.mesh();
}

ScannerStatus Scanner::status() const {
  ScannerStatus status;
  status.preview_bytes = impl_->integrator.memoryBytes();
  const std::lock_guard lock(impl_->mutex);
  status.pushed = impl_->pushed, status.integrated = impl_->integrated, status.dropped = impl_->dropped;
  status.waiting = impl_->queue.size() + (impl_->working_on > impl_->newest ? 1 : 0);
  status.corrections = impl_->corrections.size();
  status.kept = impl_->kept.size(), status.kept_bytes = impl_->kept.bytes();
  return status;
}

ViewSequence Scanner::views(const KeyViews& key_views) const {
  if (!(key_views.distance >= 0) || !(key_views.angle >= 0))
    throw InvalidArgument("key_views", "distance and angle must not be negative");
  const std::lock_guard lock(impl_->mutex);
  return impl_->kept.sequence(key_views);
}

Reconstruction Scanner::finish(const FinishOptions& options, const Progress& progress) {
  wait(progress);
  const ViewSequence kept = views(options.key_views);
  Reconstruction result = reconstruct(kept, options.reconstruct, progress);
  if (options.colors == FinishOptions::Colors::Keep) colorReconstruction(kept, result, progress);
  return result;
}

}  // namespace vdbfuse
