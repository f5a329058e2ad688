// SPDX-License-Identifier: Apache-2.0
// A program in C11 that uses the library as one in another language would: the scene `figure` in memory,
// fused at once and live, and every status code that can be provoked. Says what went wrong, and returns 1
// then.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vdbfuse/capi/vdbfuse.h"

// What programs that are compiled already rely on. A change of these numbers is a change of
// VDBFUSE_ABI_VERSION.
_Static_assert(VDBFUSE_ABI_VERSION == 1, "the numbers below are those of version 1");
#if UINTPTR_MAX == 0xffffffffffffffffu
#define AT(type, member, offset) \
  _Static_assert(offsetof(vdbfuse_##type, member) == (offset), #type "." #member " has moved")
#define SIZE(type, bytes) _Static_assert(sizeof(vdbfuse_##type) == (bytes), #type " has another size")
AT(view, struct_size, 0);
AT(view, name, 8);
AT(view, width, 16);
AT(view, height, 20);
AT(view, fx, 24);
AT(view, cy, 48);
AT(view, distortion, 56);
AT(view, world_from_camera, 96);
AT(view, depth, 224);
AT(view, depth_row_bytes, 232);
AT(view, depth_scale, 240);
AT(view, depth_focal_baseline, 248);
AT(view, depth_type, 256);
AT(view, depth_kind, 260);
AT(view, confidence, 264);
AT(view, mask, 272);
AT(view, color, 280);
AT(view, color_width, 288);
AT(view, color_height, 292);
SIZE(view, 296);
AT(synth_options, views, 8);
AT(synth_options, arc, 20);
AT(synth_options, noise_scale, 24);
AT(synth_options, cell, 40);
AT(synth_options, seed, 48);
SIZE(synth_options, 56);
AT(topology, components, 8);
AT(topology, euler_number, 32);
AT(topology, is_closed, 40);
SIZE(topology, 48);
AT(fuse_options, method, 8);
AT(fuse_options, resolution, 12);
AT(fuse_options, voxel, 16);
AT(fuse_options, domain_min, 24);
AT(fuse_options, domain_max, 48);
AT(fuse_options, sensor, 72);
AT(fuse_options, noise_scale, 80);
AT(fuse_options, outliers, 88);
AT(fuse_options, thickness, 96);
AT(fuse_options, truncation, 104);
AT(fuse_options, trim, 112);
AT(fuse_options, min_component, 120);
AT(fuse_options, simplify, 128);
AT(fuse_options, memory_bytes, 136);
AT(fuse_options, threads, 144);
AT(fuse_options, colors, 148);
AT(fuse_options, key_distance, 152);
AT(fuse_options, key_angle, 160);
AT(fuse_options, progress, 168);
AT(fuse_options, progress_data, 176);
SIZE(fuse_options, 184);
AT(scanner_options, voxel, 8);
AT(scanner_options, truncation, 16);
AT(scanner_options, near_depth, 24);
AT(scanner_options, far_depth, 32);
AT(scanner_options, queue_capacity, 40);
AT(scanner_options, memory_bytes, 48);
AT(scanner_options, sensor, 56);
AT(scanner_options, when_full, 64);
AT(scanner_options, colors, 68);
SIZE(scanner_options, 72);
AT(scanner_status, pushed, 8);
AT(scanner_status, waiting, 32);
AT(scanner_status, kept_bytes, 56);
SIZE(scanner_status, 64);
#endif

static int failures = 0;

static void check(int is_right, const char* what, int line) {
  if (is_right) return;
  ++failures;
  fprintf(stderr, "line %d: %s (last error: %s)\n", line, what, vdbfuse_last_error());
}
#define CHECK(condition) check((condition) != 0, #condition, __LINE__)

// A call that must fail with this status, and words in its message.
static void check_refused(vdbfuse_status status, vdbfuse_status expected, const char* words, int line) {
  if (status == expected && strstr(vdbfuse_last_error(), words) != NULL) return;
  ++failures;
  fprintf(stderr, "line %d: expected '%s' with '%s', found '%s' with '%s'\n", line,
          vdbfuse_status_name(expected), words, vdbfuse_status_name(status), vdbfuse_last_error());
}
#define REFUSED(call, expected, words) check_refused((call), (expected), (words), __LINE__)

enum { kViews = 20, kWidth = 96, kHeight = 72 };  // at most

// How much work it is. Under valgrind everything takes fifty times as long, and threads wait for each other.
static struct {
  int32_t views, width, height, resolution, threads;
  size_t triangles;  // that come of it at least
  double cell;       // of the scene
} size = {kViews, kWidth, kHeight, 40, 0, 500, 1.0 / 160};

static void take_a_small_size(void) {
  size.views = 10;
  size.width = 48;
  size.height = 36;
  size.resolution = 20;
  size.threads = 1;
  size.triangles = 100;
  size.cell = 1.0 / 64;
}

static size_t view_count(void) { return (size_t)size.views; }

static vdbfuse_views* synthetic_figure(void) {
  vdbfuse_synth_options synth;
  vdbfuse_views* views = NULL;
  CHECK(vdbfuse_synth_options_init(&synth, sizeof synth) == VDBFUSE_OK);
  synth.views = size.views;
  synth.width = size.width;
  synth.height = size.height;
  synth.cell = size.cell;
  CHECK(vdbfuse_views_synthesize("figure", &synth, &views) == VDBFUSE_OK);
  CHECK(vdbfuse_views_count(views) == view_count());
  return views;
}

static vdbfuse_view view_of(vdbfuse_views* views, size_t index) {
  vdbfuse_view view;
  CHECK(vdbfuse_view_init(&view, sizeof view) == VDBFUSE_OK);
  CHECK(vdbfuse_views_get(views, index, &view) == VDBFUSE_OK);
  return view;
}

static vdbfuse_fuse_options fuse_options(void) {
  vdbfuse_fuse_options options;
  CHECK(vdbfuse_fuse_options_init(&options, sizeof options) == VDBFUSE_OK);
  options.resolution = size.resolution;
  options.threads = size.threads;
  return options;
}

static int same_mesh(const vdbfuse_mesh* a, const vdbfuse_mesh* b) {
  const size_t vertices = vdbfuse_mesh_vertex_count(a), triangles = vdbfuse_mesh_triangle_count(a);
  return vertices == vdbfuse_mesh_vertex_count(b) && triangles == vdbfuse_mesh_triangle_count(b) &&
         memcmp(vdbfuse_mesh_vertices(a), vdbfuse_mesh_vertices(b), vertices * 3 * sizeof(float)) == 0 &&
         memcmp(vdbfuse_mesh_triangles(a), vdbfuse_mesh_triangles(b), triangles * 3 * sizeof(uint32_t)) == 0;
}

// Closed, indices within bounds, unit normals, support for most vertices.
static void check_mesh(const vdbfuse_mesh* mesh) {
  vdbfuse_topology topology;
  topology.struct_size = sizeof topology;
  CHECK(vdbfuse_mesh_topology(mesh, &topology) == VDBFUSE_OK);
  CHECK(topology.is_closed == 1 && topology.open_edges == 0 && topology.nonmanifold_edges == 0);
  const size_t vertices = vdbfuse_mesh_vertex_count(mesh), triangles = vdbfuse_mesh_triangle_count(mesh);
  CHECK(triangles > size.triangles);
  const uint32_t* corner = vdbfuse_mesh_triangles(mesh);
  size_t outside = 0, supported = 0, bent = 0;
  for (size_t i = 0; i < 3 * triangles; ++i) outside += corner[i] >= vertices;
  const float *normal = vdbfuse_mesh_normals(mesh), *support = vdbfuse_mesh_support(mesh);
  for (size_t v = 0; v < vertices; ++v) {
    const float* n = normal + 3 * v;
    bent += fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) > 1e-3f;
    supported += support[v] > 0;
  }
  CHECK(outside == 0 && bent == 0);
  CHECK(2 * supported > vertices);
  CHECK(vdbfuse_mesh_colors(mesh) == NULL);
}

// Progress: counts its calls, and stops when there are more than it allows.
struct counter {
  int calls, allowed;
};
static int32_t count_calls(const char* step, double fraction, void* data) {
  struct counter* counter = data;
  CHECK(step != NULL && fraction >= 0 && fraction <= 1);
  return ++counter->calls > counter->allowed;
}

static vdbfuse_mesh* fuse_in_memory(const vdbfuse_views* views) {
  vdbfuse_fuse_options options = fuse_options();
  struct counter counter = {0, 1 << 30};
  options.progress = count_calls;
  options.progress_data = &counter;
  vdbfuse_mesh* mesh = NULL;
  CHECK(vdbfuse_fuse(views, &options, &mesh) == VDBFUSE_OK);
  CHECK(counter.calls > 10);
  check_mesh(mesh);
  vdbfuse_mesh* none = mesh;
  counter.calls = 0;
  counter.allowed = 5;
  REFUSED(vdbfuse_fuse(views, &options, &none), VDBFUSE_CANCELLED, "cancelled");
  CHECK(none == NULL && counter.calls > 5);
  return mesh;
}

// The same views, handed over one by one with depths of 16 bits, upside down in memory.
static void fuse_own_images(vdbfuse_views* figure) {
  static uint16_t depths[kViews][kHeight][kWidth];
  vdbfuse_views* views = NULL;
  CHECK(vdbfuse_views_create(&views) == VDBFUSE_OK);
  for (size_t i = 0; i < view_count(); ++i) {
    vdbfuse_view view = view_of(figure, i);
    const float* from = view.depth;
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x)
        depths[i][view.height - 1 - y][x] = (uint16_t)lrintf(20000 * from[y * view.width + x]);
    view.depth = depths[i][view.height - 1];
    view.depth_row_bytes = -(int64_t)sizeof depths[i][0];
    view.depth_type = VDBFUSE_DEPTH_UINT16;
    view.depth_scale = 1.0 / 20000;
    view.name = NULL;
    CHECK(vdbfuse_views_add(views, &view) == VDBFUSE_OK);
  }
  memset(depths, 0, sizeof depths);  // they were copied
  vdbfuse_fuse_options options = fuse_options();
  options.method = VDBFUSE_METHOD_TSDF;
  vdbfuse_mesh* mesh = NULL;
  CHECK(vdbfuse_fuse(views, &options, &mesh) == VDBFUSE_OK);
  CHECK(vdbfuse_mesh_triangle_count(mesh) > size.triangles);
  vdbfuse_mesh_destroy(mesh);
  vdbfuse_views_destroy(views);
}

static void check_preview(vdbfuse_scanner* scanner, uint64_t newest) {
  vdbfuse_preview* preview = NULL;
  CHECK(vdbfuse_scanner_preview(scanner, &preview) == VDBFUSE_OK);
  CHECK(vdbfuse_preview_newest(preview) == newest);
  const size_t count = vdbfuse_preview_changed_count(preview);
  CHECK(count > 0);
  size_t triangles = 0;
  for (size_t i = 0; i < count; ++i) {
    int32_t origin[3];
    triangles += vdbfuse_mesh_triangle_count(vdbfuse_preview_changed(preview, i, origin));
    CHECK(origin[0] % 32 == 0 && origin[1] % 32 == 0 && origin[2] % 32 == 0);
  }
  CHECK(vdbfuse_preview_changed(preview, count, NULL) == NULL);
  CHECK(vdbfuse_preview_removed_count(preview) == 0 && vdbfuse_preview_removed(preview) == NULL);
  vdbfuse_mesh* mesh = NULL;
  CHECK(vdbfuse_scanner_mesh(scanner, &mesh) == VDBFUSE_OK);
  CHECK(vdbfuse_mesh_triangle_count(mesh) == triangles);
  vdbfuse_mesh_destroy(mesh);
  vdbfuse_preview_destroy(preview);
}

static vdbfuse_scanner* make_scanner(void) {
  vdbfuse_scanner_options options;
  CHECK(vdbfuse_scanner_options_init(&options, sizeof options) == VDBFUSE_OK);
  options.voxel = 0.02;
  options.when_full = VDBFUSE_WAIT;
  vdbfuse_scanner* scanner = NULL;
  CHECK(vdbfuse_scanner_create(&options, &scanner) == VDBFUSE_OK);
  return scanner;
}

// Views with wrong poses, one of them twice; corrected and removed: finish() gives the mesh of fuse().
static void scan_live(vdbfuse_views* views) {
  vdbfuse_scanner* scanner = make_scanner();
  vdbfuse_views* right = NULL;
  CHECK(vdbfuse_views_create(&right) == VDBFUSE_OK);
  uint64_t ids[kViews];
  double poses[kViews][16];
  for (size_t i = 0; i < view_count(); ++i) {
    vdbfuse_view view = view_of(views, i);
    memcpy(poses[i], view.world_from_camera, sizeof poses[i]);
    CHECK(vdbfuse_views_add(right, &view) == VDBFUSE_OK);
    view.world_from_camera[3] += 0.1;
    CHECK(vdbfuse_scanner_push(scanner, &view, &ids[i]) == VDBFUSE_OK);
    CHECK(ids[i] == i + 1);
  }
  CHECK(vdbfuse_scanner_wait(scanner) == VDBFUSE_OK);
  check_preview(scanner, view_count());
  uint64_t twice = 0;
  const vdbfuse_view again = view_of(views, 0);
  CHECK(vdbfuse_scanner_push(scanner, &again, &twice) == VDBFUSE_OK);
  CHECK(vdbfuse_scanner_remove(scanner, twice) == VDBFUSE_OK);
  CHECK(vdbfuse_scanner_correct_poses(scanner, view_count(), ids, &poses[0][0]) == VDBFUSE_OK);
  const vdbfuse_fuse_options options = fuse_options();
  vdbfuse_mesh *mesh = NULL, *expected = NULL;
  CHECK(vdbfuse_scanner_finish(scanner, &options, &mesh) == VDBFUSE_OK);
  CHECK(vdbfuse_fuse(right, &options, &expected) == VDBFUSE_OK);
  CHECK(same_mesh(mesh, expected));
  vdbfuse_scanner_status status;
  status.struct_size = sizeof status;
  CHECK(vdbfuse_scanner_get_status(scanner, &status) == VDBFUSE_OK);
  CHECK(status.pushed == view_count() + 1 && status.dropped == 0 && status.kept == view_count() &&
        status.waiting == 0);
  vdbfuse_mesh_destroy(mesh);
  vdbfuse_mesh_destroy(expected);
  vdbfuse_views_destroy(right);
  vdbfuse_scanner_destroy(scanner);
}

static void refuse_views(vdbfuse_views* views) {
  const vdbfuse_view good = view_of(views, 0);
  vdbfuse_view view;
  REFUSED(vdbfuse_views_create(NULL), VDBFUSE_INVALID_ARGUMENT, "out: must not be NULL");
  REFUSED(vdbfuse_views_add(NULL, &good), VDBFUSE_INVALID_ARGUMENT, "views: must not be NULL");
  REFUSED(vdbfuse_views_add(views, NULL), VDBFUSE_INVALID_ARGUMENT, "view: must not be NULL");
  view = good, view.struct_size = 0;
  REFUSED(vdbfuse_views_add(views, &view), VDBFUSE_INVALID_ARGUMENT, "struct_size is 0");
  view = good, view.struct_size += 8;
  REFUSED(vdbfuse_views_add(views, &view), VDBFUSE_INVALID_ARGUMENT, "struct_size is");
  view = good, view.depth = NULL;
  REFUSED(vdbfuse_views_add(views, &view), VDBFUSE_INVALID_ARGUMENT, "view.depth: must not be NULL");
  view = good, view.width = -1;
  REFUSED(vdbfuse_views_add(views, &view), VDBFUSE_INVALID_ARGUMENT, "view");
  view = good, view.fx = 0;
  REFUSED(vdbfuse_views_add(views, &view), VDBFUSE_INVALID_ARGUMENT, "focal");
  view = good, view.depth_type = 7;
  REFUSED(vdbfuse_views_add(views, &view), VDBFUSE_INVALID_ARGUMENT, "view.depth_type: 7 is none of 0 to 1");
  view = good, view.depth_kind = -1;
  REFUSED(vdbfuse_views_add(views, &view), VDBFUSE_INVALID_ARGUMENT, "view.depth_kind: -1 is none of 0 to 3");
  view = good, view.depth_scale = 0;
  REFUSED(vdbfuse_views_add(views, &view), VDBFUSE_INVALID_ARGUMENT, "scale");
  view = good, view.world_from_camera[0] += 0.5;
  REFUSED(vdbfuse_views_add(views, &view), VDBFUSE_INVALID_ARGUMENT, "rotation");
  view = good, view.world_from_camera[12] = 1;
  REFUSED(vdbfuse_views_add(views, &view), VDBFUSE_INVALID_ARGUMENT, "the last four of them 0 0 0 1");
  view = good, view.world_from_camera[3] = NAN;
  REFUSED(vdbfuse_views_add(views, &view), VDBFUSE_INVALID_ARGUMENT, "expected finite numbers");
  view = good, view.color = (const uint8_t*)"black";
  REFUSED(vdbfuse_views_add(views, &view), VDBFUSE_INVALID_ARGUMENT, "view.color: its width and height");
  REFUSED(vdbfuse_views_get(views, view_count(), &view), VDBFUSE_INVALID_ARGUMENT, "index: is ");
  CHECK(vdbfuse_views_count(views) == view_count());
}

static void refuse_sources(void) {
  vdbfuse_views* views = NULL;
  REFUSED(vdbfuse_views_read(NULL, &views), VDBFUSE_INVALID_ARGUMENT, "path: must not be NULL");
  REFUSED(vdbfuse_views_read("/nowhere/at/all", &views), VDBFUSE_IO_ERROR, "/nowhere/at/all");
  REFUSED(vdbfuse_views_synthesize("unicorn", NULL, &views), VDBFUSE_INVALID_ARGUMENT, "unicorn");
  vdbfuse_synth_options synth;
  REFUSED(vdbfuse_synth_options_init(&synth, 4), VDBFUSE_INVALID_ARGUMENT, "struct_size is 4");
  CHECK(vdbfuse_synth_options_init(&synth, sizeof synth) == VDBFUSE_OK);
  synth.cell = 0;
  REFUSED(vdbfuse_views_synthesize("box", &synth, &views), VDBFUSE_INVALID_ARGUMENT, "cell");
  synth.arc = 9;
  REFUSED(vdbfuse_views_synthesize("box", &synth, &views), VDBFUSE_INVALID_ARGUMENT, "options.arc: 9");
  CHECK(views == NULL);
}

static void refuse_fusion(const vdbfuse_views* views, const vdbfuse_mesh* mesh) {
  vdbfuse_fuse_options options = fuse_options();
  vdbfuse_mesh* none = NULL;
  REFUSED(vdbfuse_fuse(NULL, &options, &none), VDBFUSE_INVALID_ARGUMENT, "views: must not be NULL");
  REFUSED(vdbfuse_fuse(views, &options, NULL), VDBFUSE_INVALID_ARGUMENT, "out: must not be NULL");
  options.method = 3;
  REFUSED(vdbfuse_fuse(views, &options, &none), VDBFUSE_INVALID_ARGUMENT, "options.method: 3");
  options = fuse_options(), options.voxel = -1;
  REFUSED(vdbfuse_fuse(views, &options, &none), VDBFUSE_INVALID_ARGUMENT, "options");
  options = fuse_options(), options.threads = -1;
  REFUSED(vdbfuse_fuse(views, &options, &none), VDBFUSE_INVALID_ARGUMENT, "options.threads");
  options = fuse_options(), options.sensor = "eye";
  REFUSED(vdbfuse_fuse(views, &options, &none), VDBFUSE_INVALID_ARGUMENT, "eye");
  options = fuse_options(), options.struct_size = 1000;
  REFUSED(vdbfuse_fuse(views, &options, &none), VDBFUSE_INVALID_ARGUMENT, "struct_size is 1000");
  vdbfuse_views* empty = NULL;
  CHECK(vdbfuse_views_create(&empty) == VDBFUSE_OK);
  REFUSED(vdbfuse_fuse(empty, NULL, &none), VDBFUSE_INVALID_ARGUMENT, "views");
  vdbfuse_views_destroy(empty);
  REFUSED(vdbfuse_mesh_write(mesh, "/nowhere/mesh.ply"), VDBFUSE_IO_ERROR, "/nowhere/mesh.ply");
  REFUSED(vdbfuse_mesh_write(NULL, "mesh.ply"), VDBFUSE_INVALID_ARGUMENT, "mesh: must not be NULL");
  vdbfuse_topology topology;
  topology.struct_size = 3;
  REFUSED(vdbfuse_mesh_topology(mesh, &topology), VDBFUSE_INVALID_ARGUMENT, "topology: struct_size is 3");
}

static void refuse_scans(void) {
  vdbfuse_scanner_options options;
  vdbfuse_scanner* none = NULL;
  CHECK(vdbfuse_scanner_options_init(&options, sizeof options) == VDBFUSE_OK);
  REFUSED(vdbfuse_scanner_create(&options, &none), VDBFUSE_INVALID_ARGUMENT, "voxel must be positive");
  REFUSED(vdbfuse_scanner_create(NULL, &none), VDBFUSE_INVALID_ARGUMENT, "options: must not be NULL");
  options.voxel = 0.02;
  options.when_full = 5;
  REFUSED(vdbfuse_scanner_create(&options, &none), VDBFUSE_INVALID_ARGUMENT, "options.when_full: 5");
  CHECK(none == NULL);
  REFUSED(vdbfuse_scanner_wait(NULL), VDBFUSE_INVALID_ARGUMENT, "scanner: must not be NULL");
  vdbfuse_scanner* scanner = make_scanner();
  uint64_t id = 7;
  const double zero[16] = {0};
  REFUSED(vdbfuse_scanner_push(scanner, NULL, &id), VDBFUSE_INVALID_ARGUMENT, "view: must not be NULL");
  CHECK(id == 0);
  REFUSED(vdbfuse_scanner_remove(scanner, 5), VDBFUSE_INVALID_ARGUMENT, "there is none with number 5");
  REFUSED(vdbfuse_scanner_correct_poses(scanner, 1, &id, zero), VDBFUSE_INVALID_ARGUMENT,
          "world_from_camera");
  REFUSED(vdbfuse_scanner_correct_poses(scanner, 1, NULL, zero), VDBFUSE_INVALID_ARGUMENT, "ids");
  vdbfuse_mesh* mesh = NULL;
  REFUSED(vdbfuse_scanner_finish(scanner, NULL, &mesh), VDBFUSE_INVALID_ARGUMENT, "views");
  vdbfuse_scanner_destroy(scanner);
}

static void take_null_where_it_does_no_harm(void) {
  vdbfuse_views_destroy(NULL);
  vdbfuse_mesh_destroy(NULL);
  vdbfuse_scanner_destroy(NULL);
  vdbfuse_preview_destroy(NULL);
  CHECK(vdbfuse_views_count(NULL) == 0 && vdbfuse_mesh_vertex_count(NULL) == 0);
  CHECK(vdbfuse_mesh_vertices(NULL) == NULL && vdbfuse_mesh_support(NULL) == NULL);
  CHECK(vdbfuse_preview_changed(NULL, 0, NULL) == NULL && vdbfuse_preview_newest(NULL) == 0);
}

// abi_test [small]
int main(int argc, char** argv) {
  if (argc > 1 && strcmp(argv[1], "small") == 0) take_a_small_size();
  CHECK(vdbfuse_abi_version() == VDBFUSE_ABI_VERSION);
  CHECK(strlen(vdbfuse_version()) >= 5 && vdbfuse_last_error()[0] == '\0');
  CHECK(strcmp(vdbfuse_status_name(VDBFUSE_CANCELLED), "cancelled") == 0);
  vdbfuse_views* figure = synthetic_figure();
  vdbfuse_mesh* mesh = fuse_in_memory(figure);
  fuse_own_images(figure);
  scan_live(figure);
  refuse_views(figure);
  refuse_sources();
  refuse_fusion(figure, mesh);
  refuse_scans();
  take_null_where_it_does_no_harm();
  printf("figure: %zu vertices, %zu triangles; %d checks failed\n", vdbfuse_mesh_vertex_count(mesh),
         vdbfuse_mesh_triangle_count(mesh), failures);
  vdbfuse_mesh_destroy(mesh);
  vdbfuse_views_destroy(figure);
  return failures == 0 ? 0 : 1;
}
