#define DIAG
#include "fast_path_test.cpp"
namespace vdbfuse { namespace {
TEST(Diag, Paper) {
  for (const TexturedScene* scene : {&kSlanted, &kBall}) {
  const Set set = setOf(*scene);
  const auto fast = match(set, sweepsOfPlanes()), slow = match(set, paper());
  int hist[6] = {}, second=0, bad=0, votersdiff=0, allbad_smooth=0; int perview[5]={};
  for (std::size_t i = 0; i < 5; ++i) {
    const DepthMap &a = fast.views[i].view.map, &b = slow.views[i].view.map;
    const double step = stereo::kPaperStep * inverseDepthOfPixel(set, slow.views[i], i);
    double fastpixel = fast.views[i].noise.quadratic / fast.views[i].matching_error_px;
    printf("view %zu paper step %g fast step %g\n", i, step, 0.5*fastpixel);
    for (int y=0;y<72;++y) for (int x=0;x<96;++x) {
      if (std::min(a.confidence(x,y), b.confidence(x,y)) < 0.5F) continue;
      const double off = std::abs(1 / double{a.depth(x,y)} - 1 / double{b.depth(x,y)}) / step;
      if (off<=0.5) continue;
      ++bad; ++perview[i];
      ++hist[off<1?0:off<2?1:off<4?2:off<8?3:4];
      votersdiff += fast.views[i].voters(x,y)!=slow.views[i].voters(x,y);
      if (off>4) second += slow.views[i].second_best(x,y) > 0.9f*b.confidence(x,y);
      allbad_smooth += isSmooth(set.truths[i],x,y);
      if (bad%40==0) { printf("%zu %d,%d off %.2f signed %.2f conf %.3f %.3f second %.3f %.3f voters %d %d err fast %.2f slow %.2f\n", i,x,y,off,(1 / double{a.depth(x,y)} - 1 / double{b.depth(x,y)}) / step,a.confidence(x,y),b.confidence(x,y),fast.views[i].second_best(x,y),slow.views[i].second_best(x,y),fast.views[i].voters(x,y),slow.views[i].voters(x,y),
       (1 / double{a.depth(x,y)} - 1 / double{set.truths[i](x,y)}) / step,(1 / double{b.depth(x,y)} - 1 / double{set.truths[i](x,y)}) / step); }
    }
  }
  printf("bad %d hist %d %d %d %d %d  far with close second %d votersdiff %d smooth %d views %d %d %d %d %d\n", bad, hist[0],hist[1],hist[2],hist[3],hist[4],second,votersdiff,allbad_smooth,perview[0],perview[1],perview[2],perview[3],perview[4]);
  }
}
}}
