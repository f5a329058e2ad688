// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/synth/synthetic_scan.h"

#include "cameras.h"
#include "mistakes.h"
#include "picture.h"
#include "seen_surface.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/rows.h"

namespace vdbfuse {
namespace {

std::string joined(const std::vector<std::string>& sentences) {
  std::string all;
  for (const std::string& s : sentences) all += (all.empty() ? "" : "; ") + s;
  return all;
}

const SynthOptions& checked(const SynthOptions& options) {
  const std::vector<std::string> problems = validate(options);
  if (!problems.empty()) throw InvalidArgument("options", joined(problems));
  return options;
}

}  // namespace

struct SyntheticScan::Impl {
  Impl(Scene s, const SynthOptions& o)
      : options(checked(o)),
        scene(o.arc == Arc::Room ? inRoom(std::move(s)) : std::move(s)),
        headers(synth::placeCameras(scene, o)),
        surface(scene, o.background) {}

  SynthOptions options;
  Scene scene;
  std::vector<ViewHeader> headers;
  synth::SeenSurface surface;

  // Fills `seen(x, y, point)` for every pixel that sees something.
  template <class Seen>
  void look(std::size_t index, const Seen& seen) const {
    forEachRow(options.height, 8, [&](int y) {
      for (int x = 0; x < options.width; ++x)
        if (const auto point = surface.see(synth::rayThrough(headers[index], x, y))) seen(x, y, *point);
    });
  }

  Image<Rgb8> picture(std::size_t index) const {
    return synth::takePicture(headers[index], scene, surface, *options.photographs, options.seed,
                              Random(options.seed, ~index));
  }

  SyntheticView render(std::size_t index) const {
    SyntheticView result;
    static_cast<ViewHeader&>(result.view) = headers[index];
    result.true_depth = Image<float>(options.width, options.height, kInvalidDepth);
    result.object = Image<std::uint8_t>(options.width, options.height);
    look(index, [&](int x, int y, const synth::SeenPoint& point) {
      result.true_depth(x, y) = static_cast<float>(point.depth);
      result.object(x, y) = point.triangle ? 1 : 0;
    });
    synth::measure(result, options, Random(options.seed, index));
    if (options.photographs) result.view.map.color = picture(index);
    return result;
  }

  PhotographHeader photographHeader(std::size_t index) const {
    const DepthRange range = depthRange(options);
    return {headers[index].name, std::get<Pinhole>(headers[index].projection),
            headers[index].world_from_camera, DepthInterval{range.near, range.far}};
  }

  void photograph(std::size_t index, Silhouettes silhouettes, Photograph& result) const {
    result.color = picture(index);
    result.brightness = brightnessOf(result.color);
    if (silhouettes == Silhouettes::None) return;
    result.mask = Image<std::uint8_t>(options.width, options.height);
    look(index,
         [&](int x, int y, const synth::SeenPoint& point) { result.mask(x, y) = point.triangle ? 255 : 0; });
  }
};

SyntheticScan::SyntheticScan(Scene scene, const SynthOptions& options)
    : impl_(std::make_shared<const Impl>(std::move(scene), options)) {}

std::size_t SyntheticScan::size() const { return impl_->headers.size(); }
const Scene& SyntheticScan::scene() const { return impl_->scene; }
const SynthOptions& SyntheticScan::options() const { return impl_->options; }
const ViewHeader& SyntheticScan::header(std::size_t index) const { return impl_->headers[index]; }
SyntheticView SyntheticScan::render(std::size_t index) const { return impl_->render(index); }

ViewSequence SyntheticScan::views() const {
  return {impl_->headers, [impl = impl_](std::size_t index) { return impl->render(index).view.map; }};
}

PhotographHeader SyntheticScan::photographHeader(std::size_t index) const {
  return impl_->photographHeader(index);
}

PhotographSequence SyntheticScan::photographs(Silhouettes silhouettes) const {
  if (!impl_->options.photographs) throw InvalidArgument("photographs", "the scan takes none");
  std::vector<PhotographHeader> headers;
  for (std::size_t i = 0; i < size(); ++i) headers.push_back(impl_->photographHeader(i));
  return {std::move(headers), [impl = impl_, silhouettes](std::size_t index, Photograph& photograph) {
            impl->photograph(index, silhouettes, photograph);
          }};
}

std::vector<SyntheticView> renderAll(const SyntheticScan& scan, const Progress& progress) {
  std::vector<SyntheticView> views(scan.size());
  ProgressStep step(progress, "scanning", scan.size());
  parallelFor(scan.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      views[i] = scan.render(i);
      step.advance();
    }
  });
  return views;
}

ScanStatistics& operator+=(ScanStatistics& sum, const ScanStatistics& other) {
  sum.pixels += other.pixels;
  sum.object_pixels += other.object_pixels;
  sum.object_measured += other.object_measured;
  sum.object_wrong += other.object_wrong;
  sum.background_measured += other.background_measured;
  sum.background_wrong += other.background_wrong;
  return sum;
}

ScanStatistics statistics(const SyntheticView& view) {
  ScanStatistics s;
  s.pixels = view.object.size();
  for (std::size_t i = 0; i < view.object.size(); ++i) {
    const bool object = view.object.data()[i] != 0, wrong = view.mistake.data()[i] != 0;
    const bool measured = view.view.map.depth.data()[i] > 0;
    s.object_pixels += object ? 1 : 0;
    (object ? s.object_measured : s.background_measured) += measured ? 1 : 0;
    (object ? s.object_wrong : s.background_wrong) += wrong ? 1 : 0;
  }
  return s;
}

}  // namespace vdbfuse
