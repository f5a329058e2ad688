// SPDX-License-Identifier: Apache-2.0
#include "stereo/other_voters.h"

namespace vdbfuse::stereo {
namespace {

void addRow(const Testimony& view, const PlaneMap& planes, const SweepTile& tile, const SweepRange& range,
            int y, float* step, float* score) {
  const float* inverse_depth = view.inverse_depth.row(tile.y0 + y) + tile.x0;
  const float* weight = view.weight.row(tile.y0 + y) + tile.x0;
  const float *off_x = view.off_x.row(tile.y0 + y) + tile.x0, *off_y = view.off_y.row(tile.y0 + y) + tile.x0;
  const float *dx = planes.dx.row(tile.y0 + y) + tile.x0, *dy = planes.dy.row(tile.y0 + y) + tile.x0;
  const float* base = tile.base.data() + tile.at(tile.radius, tile.radius + y);
  const float* inverse_spread = tile.inverse_spread.data() + tile.at(0, y);
  for (int x = 0; x < tile.width; ++x) {
    const float slant = dx[x] * off_x[x] + dy[x] * off_y[x];
    step[x] = (inverse_depth[x] - slant - (base[x] + range.first)) / range.step;
    score[x] = inverse_spread[x] > 0 ? kOtherViewsWeight * weight[x] : 0.0F;
  }
}

}  // namespace

void addOtherVoters(const std::vector<Testimony>& others, const PlaneMap& planes, const SweepTile& tile,
                    const SweepRange& range, OtherVoters& memory, std::vector<VoterRows>& rows) {
  const std::size_t size = tile.at(0, tile.height);
  memory.step.resize(others.size() * size), memory.score.assign(others.size() * size, 0.0F);
  memory.curvature.assign(size, kOtherViewsCurvature);
  int voter = rows.empty() ? 0 : rows.back().voter + 1;
  for (std::size_t v = 0; v < others.size(); ++v) {
    float *step = memory.step.data() + v * size, *score = memory.score.data() + v * size;
    for (int y = 0; y < tile.height; ++y)
      addRow(others[v], planes, tile, range, y, step + tile.at(0, y), score + tile.at(0, y));
    rows.push_back({step, score, memory.curvature.data(), voter++});
  }
}

}  // namespace vdbfuse::stereo
