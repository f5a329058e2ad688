// SPDX-License-Identifier: Apache-2.0
// A live scan: a sensor pushes frames at its own rate, a viewer asks for what changed of the surface, poses
// of the second half turn out to have drifted and are corrected, and at the end the global cut of all frames
// is made.
//   example_07_live_scanning [FOLDER] [--rate HZ] [--voxel SIZE] [--frames N] [--size WxH] [--far DEPTH]
//                [--key-distance L] [--out MESH.ply]
// FOLDER: a data set of depth maps, played over and over until N frames are pushed; without it a synthetic
// room. Prints the rate that was kept, how old a frame was when a preview showed it, and how long finish()
// took.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/pipeline/scanner.h"
#include "vdbfuse/synth/synthetic_scan.h"

namespace {

using namespace vdbfuse;
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

struct Request {
  std::string folder, out;
  double rate = 30, voxel = 0.05, far = std::numeric_limits<double>::infinity(), key_distance = 0.0;
  std::size_t frames = 40;
  int width = 160, height = 120;
};

Request parse(int argc, char** argv) {
  Request request;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name.rfind("--", 0) != 0) {
      request.folder = name;
      continue;
    }
    if (++i == argc) throw std::invalid_argument(name + " needs a value");
    const char* const value = argv[i];
    if (name == "--rate")
      request.rate = std::atof(value);
    else if (name == "--voxel")
      request.voxel = std::atof(value);
    else if (name == "--far")
      request.far = std::atof(value);
    else if (name == "--key-distance")
      request.key_distance = std::atof(value);
    else if (name == "--frames")
      request.frames = static_cast<std::size_t>(std::atoi(value));
    else if (name == "--out")
      request.out = value;
    else if (name == "--size") {
      if (std::sscanf(value, "%dx%d", &request.width, &request.height) != 2)
        throw std::invalid_argument("--size is WxH");
    } else
      throw std::invalid_argument("there is no " + name);
  }
  if (!(request.rate > 0) || request.frames == 0) throw std::invalid_argument("--rate and --frames are > 0");
  return request;
}

// Everything is loaded before the clock runs: a sensor has its frames in memory.
std::vector<View> loadFrames(const Request& request) {
  ViewSequence sequence;
  if (request.folder.empty()) {
    SynthOptions camera;
    camera.views = static_cast<int>(std::min<std::size_t>(request.frames, 300));
    camera.width = request.width, camera.height = request.height;
    camera.arc = Arc::Ring;  // around a figure in the middle of a room, whose walls are seen behind it
    camera.focal_px = 0.8 * request.width;
    camera.confidence = ConfidenceKind::None;
    camera.quantum = 0.001;
    sequence = SyntheticScan(inRoom(makeScene("figure")), camera).views();
  } else {
    ReadOptions read;
    read.color = ReadOptions::Color::Skip;
    sequence = readDepthSet(request.folder, read).views;
  }
  std::vector<View> frames;
  for (std::size_t i = 0; i < std::min(sequence.size(), request.frames); ++i)
    frames.push_back(sequence.load(i));
  return frames;
}

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

// How long each frame takes from the sensor to the viewer.
class Ages {
 public:
  void pushed(ViewId id, Clock::time_point when) {
    const std::lock_guard lock(mutex_);
    if (id > when_.size()) when_.resize(id);
    when_[id - 1] = when;
  }
  void shown(ViewId newest) {
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    for (; shown_ < std::min<std::size_t>(newest, when_.size()); ++shown_)
      seconds_.push_back(Seconds(now - when_[shown_]).count());
  }
  const std::vector<double>& seconds() const { return seconds_; }

 private:
  std::mutex mutex_;
  std::vector<Clock::time_point> when_;
  std::size_t shown_ = 0;
  std::vector<double> seconds_;
};

struct Viewer {
  std::vector<double> seconds;  // that a preview took
  std::size_t blocks = 0, triangles = 0;

  // Looks again and again, ten times a second at most: the rest of the time is the sensor's.
  void run(Scanner& scanner, Ages& ages, const std::atomic<bool>& done) {
    while (!done) {
      const Clock::time_point begin = Clock::now();
      const ScannerPreview preview = scanner.preview();
      ages.shown(preview.newest);
      if (!preview.changed.empty()) seconds.push_back(Seconds(Clock::now() - begin).count());
      for (const SurfaceBlock& block : preview.changed) ++blocks, triangles += block.mesh.triangles.size();
      std::this_thread::sleep_until(begin + std::chrono::milliseconds(100));
    }
  }
};

// The second half of the frames is off by a few voxels, as by odometry.
RigidTransform drifted(const RigidTransform& pose, bool is_late, double voxel) {
  RigidTransform drift = RigidTransform::Identity();
  if (is_late) drift.translation() = Eigen::Vector3d(2, -1, 1) * voxel;
  return drift * pose;
}

struct Session {
  std::vector<PoseCorrection> corrections;
  std::vector<double> waiting;  // views in the queue at each push
  double late = 0;              // the most that a push was behind the sensor's clock, seconds
  double seconds = 0;
};

Session play(Scanner& scanner, const std::vector<View>& frames, const Request& request, Ages& ages) {
  Session session;
  const Clock::time_point begin = Clock::now();
  for (std::size_t i = 0; i < request.frames; ++i) {
    View view = frames[i % frames.size()];
    const RigidTransform right = view.world_from_camera;
    const bool is_late = 2 * i >= request.frames;
    view.world_from_camera = drifted(right, is_late, request.voxel);
    view.name = "frame " + std::to_string(i);
    const auto due =
        begin + std::chrono::duration_cast<Clock::duration>(Seconds(static_cast<double>(i) / request.rate));
    std::this_thread::sleep_until(due);
    const Clock::time_point now = Clock::now();
    session.late = std::max(session.late, Seconds(now - due).count());
    const ViewId id = scanner.push(std::move(view)).value();  // DropOldest takes every new one
    ages.pushed(id, now);
    if (is_late) session.corrections.push_back({id, right});
    session.waiting.push_back(static_cast<double>(scanner.status().waiting));
  }
  session.seconds = Seconds(Clock::now() - begin).count();
  return session;
}

void printSession(const Session& session, const ScannerStatus& status, const Request& request) {
  std::printf("%zu frames in %.2f s: %.1f of %g Hz, push at most %.0f ms late\n", status.pushed,
              session.seconds, static_cast<double>(status.pushed - 1) / session.seconds, request.rate,
              1e3 * session.late);
  std::printf("dropped %zu, in the queue %.0f (median), %.0f (most)\n", status.dropped,
              quantile(session.waiting, 0.5), quantile(session.waiting, 1));
  std::printf("kept %zu views in %.1f MB; %.1f MB of voxels\n", status.kept,
              1e-6 * static_cast<double>(status.kept_bytes),
              1e-6 * static_cast<double>(status.preview_bytes));
}

void printViewer(const Viewer& viewer, const Ages& ages) {
  std::printf("age of a frame in the preview: %.0f ms (median), %.0f ms (most)\n",
              1e3 * quantile(ages.seconds(), 0.5), 1e3 * quantile(ages.seconds(), 1));
  const double count = static_cast<double>(std::max<std::size_t>(1, viewer.seconds.size()));
  std::printf("%zu previews of %.0f ms (median), %.0f ms (most), %.0f blocks and %.0f triangles each\n",
              viewer.seconds.size(), 1e3 * quantile(viewer.seconds, 0.5), 1e3 * quantile(viewer.seconds, 1),
              static_cast<double>(viewer.blocks) / count, static_cast<double>(viewer.triangles) / count);
}

void closeLoop(Scanner& scanner, const Session& session) {
  const Clock::time_point begin = Clock::now();
  scanner.correctPoses(session.corrections);
  scanner.wait();
  std::printf("%zu poses corrected in %.2f s\n", session.corrections.size(),
              Seconds(Clock::now() - begin).count());
}

bool finish(Scanner& scanner, const Request& request) {
  FinishOptions options;
  options.reconstruct.voxel = request.voxel;
  options.key_views.distance = request.key_distance;
  options.key_views.angle = 10 * request.key_distance;  // a tenth of a length unit counts as 57°
  const Clock::time_point begin = Clock::now();
  const Reconstruction result = scanner.finish(options);
  const bool is_closed = isClosedManifold(topology(result.mesh));
  std::printf("finish() with %zu views: %.1f s, %zu triangles, %s\n", scanner.views(options.key_views).size(),
              Seconds(Clock::now() - begin).count(), result.mesh.triangles.size(),
              is_closed ? "closed" : "not closed");
  if (!request.out.empty()) writeMesh(request.out, result.mesh);
  return is_closed;
}

bool run(const Request& request) {
  const std::vector<View> frames = loadFrames(request);
  ScannerOptions options;
  options.preview.voxel = request.voxel;
  options.preview.noise = sensorPreset("kinect").noise;
  options.far = request.far;
  Scanner scanner(options);
  Ages ages;
  Viewer viewer;
  std::atomic<bool> done = false;
  std::thread looks([&] { viewer.run(scanner, ages, done); });
  const Session session = play(scanner, frames, request, ages);
  scanner.wait();
  std::this_thread::sleep_for(std::chrono::milliseconds(500));  // the viewer's last look
  done = true;
  looks.join();
  printSession(session, scanner.status(), request);
  printViewer(viewer, ages);
  closeLoop(scanner, session);
  return finish(scanner, request);
}

}  // namespace

int main(int argc, char** argv) try {
  return run(parse(argc, argv)) ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
