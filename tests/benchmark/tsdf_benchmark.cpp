// SPDX-License-Identifier: Apache-2.0
// What integrating depth maps into a TSDF costs, and what comes of it.
//   tsdf_benchmark speed FOLDER: milliseconds a frame, allocation included, decoding excluded, and the memory
//   of the grid. Truncation 4 voxels. peer_integration.py runs it beside Open3D. tsdf_benchmark removal
//   FOLDER: all frames in and every second one out again, beside the others alone. tsdf_benchmark floaters
//   FOLDER: 2 % of the pixels replaced by any depth; what lies further than the truncation from the
//   surface of the scan without them, with and without carving. tsdf_benchmark color: a sphere with a
//   pattern, seen by a noisy depth camera; mean error of the vertices' colours.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/random.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/fusion/measurement_weight.h"
#include "vdbfuse/fusion/tsdf.h"
#include "vdbfuse/mesh/closest_point.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/surface/extract.h"
#include "vdbfuse/synth/synthetic_scan.h"

namespace {

using namespace vdbfuse;
using Clock = std::chrono::steady_clock;

const NoiseLaw kKinect = NoiseLaw::structuredLight();

struct Request {
  std::string folder;
  std::size_t frames = 100;
  std::vector<double> voxels = {0.01, 0.005};
  std::vector<int> threads = {1, 2};
  bool json = false;
};

std::vector<View> load(const Request& request) {
  const ViewSequence sequence = readDepthSet(request.folder).views.first(request.frames);
  std::vector<View> views;
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    views.push_back(sequence.load(i));
    views.back().map.color = {};
  }
  return views;
}

TsdfOptions optionsFor(double voxel) {
  TsdfOptions options;
  options.truncation = 4 * voxel;
  return options;
}

Image<float> weigh(const View& view, double voxel) { return measurementWeights(view, kKinect, voxel, {}); }

struct Setting {
  const char* name;
  bool weighted;
  TsdfStorage storage;
  bool carves;
};

constexpr Setting kSettings[] = {
    {"weight 1", false, TsdfStorage::Single, false},
    {"weighted", true, TsdfStorage::Single, false},
    {"weighted, half", true, TsdfStorage::Half, false},
    {"weighted, carving", true, TsdfStorage::Single, true},
};

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

void measureSpeed(const Request& request, const std::vector<View>& views, double voxel, int threads,
                  const Setting& setting) {
  const ThreadLimit limit(threads);
  TsdfOptions options = optionsFor(voxel);
  options.storage = setting.storage;
  TsdfVolume volume({voxel}, options);
  std::vector<double> times;
  for (const View& view : views) {
    const auto begin = Clock::now();
    if (setting.weighted) {
      const Image<float> weights = weigh(view, voxel);
      volume.integrate({view, view.map.depth, &weights});
      if (setting.carves) volume.carve({view, view.map.depth, &weights});
    } else {
      volume.integrate({view, view.map.depth});
    }
    times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
  }
  double mean = 0;
  for (const double t : times) mean += t / static_cast<double>(times.size());
  std::printf(request.json
                  ? "{\"setting\": \"%s\", \"voxel\": %g, \"threads\": %d, \"ms\": %.3f, \"median\": %.3f, "
                    "\"slowest\": %.3f, \"leaves\": %zu, \"megabytes\": %.3f}\n"
                  : "| %s | %g | %d | %.2f | %.2f | %.2f | %zu | %.2f |\n",
              setting.name, voxel, threads, mean, quantile(times, 0.5), quantile(times, 0.99),
              volume.leafCount(), 1e-6 * static_cast<double>(volume.memoryBytes()));
  std::fflush(stdout);
}

void speed(const Request& request) {
  const std::vector<View> views = load(request);
  if (!request.json)
    std::printf(
        "| setting | voxel | threads | ms a frame | median | 99 %% | leaves | MB |\n"
        "|---|---|---|---|---|---|---|---|\n");
  for (const double voxel : request.voxels)
    for (const int threads : request.threads)
      for (const Setting& setting : kSettings) measureSpeed(request, views, voxel, threads, setting);
}

void removal(const Request& request) {
  const std::vector<View> views = load(request);
  std::printf(
      "| voxel | storage | voxels known | known in one only | largest difference | of the truncation |\n"
      "|---|---|---|---|---|---|\n");
  for (const double voxel : request.voxels) {
    for (const TsdfStorage storage : {TsdfStorage::Single, TsdfStorage::Half}) {
      TsdfOptions options = optionsFor(voxel);
      options.storage = storage;
      TsdfVolume all({voxel}, options), others({voxel}, options);
      for (std::size_t i = 0; i < views.size(); ++i) {
        const Image<float> weights = weigh(views[i], voxel);
        all.integrate({views[i], views[i].map.depth, &weights});
        if (i % 2 == 1) others.integrate({views[i], views[i].map.depth, &weights});
      }
      for (std::size_t i = 0; i < views.size(); i += 2) {
        const Image<float> weights = weigh(views[i], voxel);
        all.remove({views[i], views[i].map.depth, &weights});
      }
      const ScalarGrid a = all.distance(), b = others.distance();
      std::size_t known = 0, only_one = a.leafCount() == b.leafCount() ? 0 : 1;
      float largest = 0;
      for (std::size_t leaf = 0; leaf < b.leafCount(); ++leaf) {
        const ScalarGrid::Leaf right = b.leaf(leaf);
        const auto left = a.findLeaf(right.origin);
        for (std::size_t k = 0; k < right.values.size(); ++k) {
          const float x = left ? a.leaf(*left).values[k] : kUnknown, y = right.values[k];
          only_one += std::isnan(x) != std::isnan(y) ? 1 : 0;
          if (std::isnan(x) || std::isnan(y)) continue;
          ++known;
          largest = std::max(largest, std::abs(x - y));
        }
      }
      std::printf("| %g | %s | %zu | %zu | %.2g | %.2g |\n", voxel,
                  storage == TsdfStorage::Half ? "half" : "single", known, only_one,
                  static_cast<double>(largest), largest / options.truncation);
    }
  }
}

enum class Carve { Never, AsViewsCome, AtTheEnd };

TriangleMesh fuse(const std::vector<View>& views, double voxel, Carve carve) {
  TsdfVolume volume({voxel}, optionsFor(voxel));
  for (const View& view : views) {
    const Image<float> weights = weigh(view, voxel);
    volume.integrate({view, view.map.depth, &weights});
    if (carve == Carve::AsViewsCome) volume.carve({view, view.map.depth, &weights});
  }
  for (const View& view : views) {
    if (carve != Carve::AtTheEnd) break;
    const Image<float> weights = weigh(view, voxel);
    volume.carve({view, view.map.depth, &weights});
  }
  return extractSurface(volume.distance());
}

// The triangles whose middles lie further than `tolerance` from another surface.
TriangleMesh strays(const TriangleMesh& mesh, const ClosestPoint& other, double tolerance) {
  std::vector<std::uint8_t> is_stray(mesh.triangles.size());
  parallelFor(is_stray.size(), 1000, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& t = mesh.triangles[i];
      const Eigen::Vector3f sum = mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]];
      is_stray[i] = other.query(sum.cast<double>() / 3).distance > tolerance;
    }
  });
  TriangleMesh result;
  result.vertices = mesh.vertices;
  for (std::size_t i = 0; i < is_stray.size(); ++i)
    if (is_stray[i]) result.triangles.push_back(mesh.triangles[i]);
  dropUnusedVertices(result);
  return result;
}

void floaters(const Request& request) {
  const std::vector<View> clean = load(request);
  std::vector<View> dirty = clean;
  for (std::size_t i = 0; i < dirty.size(); ++i) {
    Random random(11, i);
    for (float& d : dirty[i].map.depth)
      if (random.uniform() < 0.02) d = static_cast<float>(random.uniform(0.5, 4.5));
  }
  const double voxel = request.voxels.front();
  std::printf(
      "| voxel %g | area m2, without outliers | with 2 %% | pieces, without | with | floating m2 | floating "
      "pieces "
      "|\n|---|---|---|---|---|---|---|\n",
      voxel);
  const auto row = [&](const char* name, Carve carve) {
    const TriangleMesh truth = fuse(clean, voxel, carve), mesh = fuse(dirty, voxel, carve),
                       floating = strays(mesh, ClosestPoint(truth), 4 * voxel);
    std::printf("| %s | %.2f | %.2f | %zu | %zu | %.4f | %zu |\n", name, area(truth), area(mesh),
                topology(truth).components, topology(mesh).components, area(floating),
                topology(floating).components);
    std::fflush(stdout);
  };
  row("not carved", Carve::Never);
  row("carved as views come", Carve::AsViewsCome);
  row("carved at the end", Carve::AtTheEnd);
}

// A smooth pattern on the sphere, with a period of about 60 mm.
Eigen::Vector3d patternAt(const Eigen::Vector3d& point) {
  const Eigen::Vector3d p = 0.5 * point.normalized();
  return {128 + 100 * std::sin(100 * p.x()), 128 + 100 * std::sin(100 * p.y() + 1),
          128 + 100 * std::sin(100 * p.z() + 2)};
}

void color(const Request&) {
  constexpr double kVoxel = 0.005;
  SynthOptions exact = kinectOptions();
  exact.noise_scale = 0, exact.quantum = 0;
  const SyntheticScan noisy(makeScene("ball"), kinectOptions()), truth(makeScene("ball"), exact);
  TsdfOptions options = optionsFor(kVoxel);
  options.colors = TsdfColors::Keep;
  TsdfVolume volume({kVoxel}, options);
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    View view = noisy.render(i).view;
    const View seen = truth.render(i).view;
    view.map.color = Image<Rgb8>(view.map.depth.width(), view.map.depth.height());
    for (int y = 0; y < view.map.color.height(); ++y) {
      for (int x = 0; x < view.map.color.width(); ++x) {
        if (seen.map.depth(x, y) == kInvalidDepth) continue;
        const Eigen::Vector3d c = patternAt(worldPoint(seen, x, y));
        for (int k = 0; k < 3; ++k)
          view.map.color(x, y)[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(std::lround(c[k]));
      }
    }
    const Image<float> weights = weigh(view, kVoxel);
    volume.integrate({view, view.map.depth, &weights, &view.map.color});
  }
  TriangleMesh mesh = extractSurface(volume.distance());
  volume.describeVertices(mesh);
  const auto error = [&](float from) {
    double sum = 0, count = 0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      if (mesh.vertices[v].z() < from) continue;
      const Eigen::Vector3d expected = patternAt(mesh.vertices[v].cast<double>());
      for (int k = 0; k < 3; ++k)
        sum += std::abs(mesh.colors[v][static_cast<std::size_t>(k)] - expected[k]), count += 1;
    }
    return sum / count;
  };
  std::printf(
      "mean colour error, of 255: %.2f where it was measured as the sphere is (z > 0.05), %.2f everywhere\n",
      error(0.05f), error(-1));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What do depth maps cost and give in a TSDF?");
  app.require_subcommand(1);
  Request request;
  const auto add = [&](const char* name, const char* about, void (*run)(const Request&), bool has_folder) {
    CLI::App* sub = app.add_subcommand(name, about);
    if (has_folder) {
      sub->add_option("folder", request.folder, "depth maps")->required()->check(CLI::ExistingDirectory);
      sub->add_option("--frames", request.frames, "the first so many");
      sub->add_option("--voxel", request.voxels, "sizes");
    }
    if (run == speed) {
      sub->add_option("--threads", request.threads, "numbers");
      sub->add_flag("--json", request.json, "a JSON object a line");
    }
    sub->callback([&request, run] { run(request); });
  };
  add("speed", "milliseconds a frame, and memory", speed, true);
  add("removal", "views taken out again", removal, true);
  add("floaters", "outliers, with and without carving", floaters, true);
  add("color", "colours of a sphere with a pattern", color, false);
  CLI11_PARSE(app, argc, argv);
}
