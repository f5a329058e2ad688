// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/view_sequence.h"

#include <algorithm>
#include <memory>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {

ViewSequence::ViewSequence(std::vector<ViewHeader> headers, Loader loader)
    : headers_(std::move(headers)), loader_(std::move(loader)) {}

ViewSequence ViewSequence::fromViews(std::vector<View> views) {
  std::vector<ViewHeader> headers(views.begin(), views.end());
  auto shared = std::make_shared<const std::vector<View>>(std::move(views));
  return {std::move(headers), [shared](std::size_t index) { return (*shared)[index].map; }};
}

View ViewSequence::load(std::size_t index) const {
  View view{headers_[index], loader_(index)};
  normaliseInvalid(view.map.depth);
  const std::vector<std::string> problems = validate(view);
  if (!problems.empty()) throw InvalidArgument("view " + view.name, problems.front());
  applyMask(view.map);
  return view;
}

ViewSequence ViewSequence::first(std::size_t count) const {
  ViewSequence result = *this;
  result.headers_.resize(std::min(count, size()));
  return result;
}

}  // namespace vdbfuse
