// SPDX-License-Identifier: Apache-2.0
// The library for C, and for every language that calls C: opaque handles, status codes, no exceptions.
//
// Handles. *_create, *_read, … give a handle that the matching *_destroy takes back; destroying NULL does
// nothing. An output handle is NULL when the call fails. Pointers into a handle live as long as it does.
// Structs. Fill with the matching *_init(&s, sizeof s), then set what differs. A struct of an older header
// keeps working: struct_size says which fields it has. Those of a newer header are refused.
// Threads. Every function of a scanner may be called from any thread at any time, but for destroy, which must
// be the last. Other handles: one thread at a time each; reading a mesh or a preview from several is fine.
// Conventions. Lengths in the unit of the poses. Camera axes: x right, y down, z forward; pixel centres at
// integers. Matrices row by row. Triangles counter-clockwise seen from outside.
#pragma once

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__) || defined(__clang__)
#define VDBFUSE_API __attribute__((visibility("default")))
#else
#define VDBFUSE_API
#endif

// C's own style of names. NOLINTBEGIN(readability-identifier-naming)
#ifdef __cplusplus
extern "C" {
#endif

/// Changes when a program that was compiled against an older header could break; new functions, and new
/// fields at the end of structs, do not change it.
#define VDBFUSE_ABI_VERSION 1
/// VDBFUSE_ABI_VERSION of the library that is loaded.
VDBFUSE_API uint32_t vdbfuse_abi_version(void);
/// "0.1.0".
VDBFUSE_API const char* vdbfuse_version(void);

enum {
  VDBFUSE_OK = 0,
  VDBFUSE_INVALID_ARGUMENT =
      1,                  ///< NULL, a size that does not fit, a pose that is none, options that are wrong
  VDBFUSE_IO_ERROR = 2,   ///< a file cannot be read or written
  VDBFUSE_CANCELLED = 3,  ///< the progress function asked to stop
  VDBFUSE_OUT_OF_MEMORY = 4,
  VDBFUSE_FAILED = 5,  ///< no result: nothing that the views agree on, for example
  VDBFUSE_INTERNAL = 6
};
/// One of the above.
typedef int32_t vdbfuse_status;

/// "invalid argument" and so on; never NULL.
VDBFUSE_API const char* vdbfuse_status_name(vdbfuse_status status);
/// One line on the last call of this thread that failed; "" when none did. Lives until this thread's next
/// failure.
VDBFUSE_API const char* vdbfuse_last_error(void);

/// Called during long calls, never from two threads at once, but perhaps not from the caller's. Returns 0 to
/// go on, anything else to stop; may be called a few more times until all threads have stopped.
typedef int32_t (*vdbfuse_progress)(const char* step, double fraction, void* data);

// ------------------------------------------------------------------------------------------------- views --

typedef struct vdbfuse_views vdbfuse_views;

enum { VDBFUSE_DEPTH_FLOAT32 = 0, VDBFUSE_DEPTH_UINT16 = 1 };
enum {
  VDBFUSE_DEPTH_Z = 0,          ///< along the camera's axis
  VDBFUSE_DEPTH_RANGE = 1,      ///< along the pixel's ray
  VDBFUSE_DEPTH_DISPARITY = 2,  ///< pixels
  VDBFUSE_DEPTH_INVERSE = 3     ///< 1/length
};

/// A depth map of a pinhole camera. Images are read row by row from the top and never kept.
typedef struct vdbfuse_view {
  uint64_t struct_size;
  const char* name;       ///< for messages; NULL: none
  int32_t width, height;  ///< of depth, confidence and mask, pixels
  double fx, fy, cx, cy;  ///< pixels
  double distortion[5];   ///< k1, k2, p1, p2, k3 as OpenCV has them; 0: none
  /// 4×4; takes points of the camera to the world. Rotations may be off by 0.02.
  double world_from_camera[16];
  const void* depth;            ///< 0 and not finite, of 16 bits also 65535: nothing measured
  int64_t depth_row_bytes;      ///< from a row to the next; negative: stored upside down; 0: packed
  double depth_scale;           ///< stored number × scale is the measure, > 0; 1
  double depth_focal_baseline;  ///< focal length [px] × baseline [length], for disparities only
  int32_t depth_type;           ///< VDBFUSE_DEPTH_FLOAT32, VDBFUSE_DEPTH_UINT16
  int32_t depth_kind;           ///< VDBFUSE_DEPTH_Z, …
  const float* confidence;      ///< of any scale; NULL: none
  const uint8_t* mask;          ///< 0 where the object is not; NULL: none
  const uint8_t* color;         ///< 3 bytes a pixel, of the same camera; NULL: none
  int32_t color_width, color_height;
} vdbfuse_view;

/// Everything 0, but for scale 1 and the pose, which is the identity.
VDBFUSE_API vdbfuse_status vdbfuse_view_init(vdbfuse_view* view, uint64_t struct_size);

VDBFUSE_API vdbfuse_status vdbfuse_views_create(vdbfuse_views** out);
/// A data set of any format that `vdbfuse formats` lists. Images are read when they are needed.
VDBFUSE_API vdbfuse_status vdbfuse_views_read(const char* path, vdbfuse_views** out);
/// Copies a view.
VDBFUSE_API vdbfuse_status vdbfuse_views_add(vdbfuse_views* views, const vdbfuse_view* view);
VDBFUSE_API size_t vdbfuse_views_count(const vdbfuse_views* views);
/// View number `index`, of a pinhole camera, with depths as packed floats. Its images lie in the handle from
/// then on. Set out->struct_size before.
VDBFUSE_API vdbfuse_status vdbfuse_views_get(vdbfuse_views* views, size_t index, vdbfuse_view* out);
VDBFUSE_API void vdbfuse_views_destroy(vdbfuse_views* views);

enum {
  VDBFUSE_ARC_FULL = 0,
  VDBFUSE_ARC_RING = 1,
  VDBFUSE_ARC_UPPER = 2,
  VDBFUSE_ARC_FRONT = 3,
  VDBFUSE_ARC_ROOM = 4
};

/// A scanner that knows the truth: `vdbfuse synth`.
typedef struct vdbfuse_synth_options {
  uint64_t struct_size;
  int32_t views;          ///< 48
  int32_t width, height;  ///< 640 × 480
  int32_t arc;            ///< where the cameras stand: VDBFUSE_ARC_FULL
  double noise_scale;     ///< standard deviation at depth 1, in diagonals of the scene: 0.001
  double outliers;        ///< share of the pixels: 0
  double cell;            ///< edge of the triangles of the scene, in its diagonals: 1/320
  uint64_t seed;          ///< 1
} vdbfuse_synth_options;
VDBFUSE_API vdbfuse_status vdbfuse_synth_options_init(vdbfuse_synth_options* options, uint64_t struct_size);
/// Scenes: sphere, box, torus, figure, occluder, ball. `options` may be NULL.
VDBFUSE_API vdbfuse_status vdbfuse_views_synthesize(const char* scene, const vdbfuse_synth_options* options,
                                                    vdbfuse_views** out);

// -------------------------------------------------------------------------------------------------- mesh --

typedef struct vdbfuse_mesh vdbfuse_mesh;

VDBFUSE_API size_t vdbfuse_mesh_vertex_count(const vdbfuse_mesh* mesh);
VDBFUSE_API size_t vdbfuse_mesh_triangle_count(const vdbfuse_mesh* mesh);
/// x, y, z of each vertex.
VDBFUSE_API const float* vdbfuse_mesh_vertices(const vdbfuse_mesh* mesh);
/// Three vertices of each triangle.
VDBFUSE_API const uint32_t* vdbfuse_mesh_triangles(const vdbfuse_mesh* mesh);
/// Of each vertex: a unit normal; red, green, blue; how much was measured there, 0 where the surface was
/// invented. NULL: the mesh has none.
VDBFUSE_API const float* vdbfuse_mesh_normals(const vdbfuse_mesh* mesh);
VDBFUSE_API const uint8_t* vdbfuse_mesh_colors(const vdbfuse_mesh* mesh);
VDBFUSE_API const float* vdbfuse_mesh_support(const vdbfuse_mesh* mesh);
/// .ply, .obj, .stl or .glb. An existing file is replaced, when all of it is written.
VDBFUSE_API vdbfuse_status vdbfuse_mesh_write(const vdbfuse_mesh* mesh, const char* path);

typedef struct vdbfuse_topology {
  uint64_t struct_size;
  uint64_t components, open_edges, nonmanifold_edges;
  int64_t euler_number;
  int32_t is_closed;  ///< 1: the boundary of a solid, 0: not
  int32_t reserved;
} vdbfuse_topology;
/// Set topology->struct_size before.
VDBFUSE_API vdbfuse_status vdbfuse_mesh_topology(const vdbfuse_mesh* mesh, vdbfuse_topology* topology);
VDBFUSE_API void vdbfuse_mesh_destroy(vdbfuse_mesh* mesh);

// ---------------------------------------------------------------------------------------------- fusion --

enum {
  VDBFUSE_METHOD_VISIBILITY = 0,  ///< global minimum cut, watertight
  VDBFUSE_METHOD_TSDF = 1         ///< Curless and Levoy, open where nothing was measured
};

/// 0 and NULL mean: from the data, unless it says otherwise.
typedef struct vdbfuse_fuse_options {
  uint64_t struct_size;
  int32_t method;        ///< VDBFUSE_METHOD_VISIBILITY
  int32_t resolution;    ///< longest side of the domain / voxel
  double voxel;          ///< or its size; half of it costs about four times as much
  double domain_min[3];  ///< world box; all six numbers 0: from the data
  double domain_max[3];
  const char* sensor;  ///< kinect, kinect2, realsense-d435, …: its noise, poses in metres
  double noise_scale;  ///< standard deviation of a depth
  double outliers;     ///< share of wrong pixels; negative (default): judged pixel by pixel
  double thickness;    ///< of solid behind a measured surface; negative (default): from the data, 0: no limit
  double truncation;   ///< of the TSDF
  double trim;         ///< cut away what fewer views than this agree on; 0: nothing
  double min_component;   ///< least diagonal of a component; 0: keep all
  uint64_t simplify;      ///< triangles to be left, about; 0: all
  uint64_t memory_bytes;  ///< that may be used; 0: 80 % of what is free
  int32_t threads;        ///< 0: all processors
  int32_t colors;         ///< 1: colour the mesh from the views' pictures
  double key_distance;    ///< vdbfuse_scanner_finish() only: views whose sensor moved no further, and turned
  double key_angle;       ///< by no more than this, since the last one used are left out; 0, 0: none are
  vdbfuse_progress progress;  ///< NULL: none
  void* progress_data;
} vdbfuse_fuse_options;
VDBFUSE_API vdbfuse_status vdbfuse_fuse_options_init(vdbfuse_fuse_options* options, uint64_t struct_size);
/// `options` may be NULL. The same mesh for any number of threads.
VDBFUSE_API vdbfuse_status vdbfuse_fuse(const vdbfuse_views* views, const vdbfuse_fuse_options* options,
                                        vdbfuse_mesh** out);

// ------------------------------------------------------------------------------------------- live scan --

typedef struct vdbfuse_scanner vdbfuse_scanner;
typedef struct vdbfuse_preview vdbfuse_preview;

/// What vdbfuse_scanner_push() does when the queue is full.
enum {
  VDBFUSE_DROP_OLDEST = 0,  ///< the view that has waited longest goes: never holds up a sensor
  VDBFUSE_DROP_NEWEST = 1,  ///< the view that comes goes
  VDBFUSE_WAIT = 2          ///< push waits: for recordings
};

typedef struct vdbfuse_scanner_options {
  uint64_t struct_size;
  double voxel;                  ///< of the preview, > 0: must be set
  double truncation;             ///< 0: four voxels
  double near_depth, far_depth;  ///< depths outside are not looked at; 0, infinity
  uint64_t queue_capacity;       ///< views that may wait: 8
  uint64_t memory_bytes;         ///< of views kept in memory; later ones lie in a file: 1 GiB
  const char* sensor;            ///< for the weights; NULL: near and far count the same
  int32_t when_full;             ///< VDBFUSE_DROP_OLDEST
  int32_t colors;                ///< 1: previews with colours
} vdbfuse_scanner_options;
VDBFUSE_API vdbfuse_status vdbfuse_scanner_options_init(vdbfuse_scanner_options* options,
                                                        uint64_t struct_size);

typedef struct vdbfuse_scanner_status {
  uint64_t struct_size;
  uint64_t pushed, integrated, dropped;  ///< views so far
  uint64_t waiting;                      ///< views in the queue
  uint64_t corrections;                  ///< poses and removals that wait
  uint64_t kept, kept_bytes;             ///< views for vdbfuse_scanner_finish()
} vdbfuse_scanner_status;

VDBFUSE_API vdbfuse_status vdbfuse_scanner_create(const vdbfuse_scanner_options* options,
                                                  vdbfuse_scanner** out);
/// Copies a view and returns at once, except with VDBFUSE_WAIT. *id (may be NULL): its number from 1, or 0
/// where it was dropped. Errors of the scanner's own thread are given once by the next call.
VDBFUSE_API vdbfuse_status vdbfuse_scanner_push(vdbfuse_scanner* scanner, const vdbfuse_view* view,
                                                uint64_t* id);
/// Takes a view out again. Returns at once.
VDBFUSE_API vdbfuse_status vdbfuse_scanner_remove(vdbfuse_scanner* scanner, uint64_t id);
/// Better poses for `count` views: 16 numbers each, as in vdbfuse_view. Returns at once; worked in when no
/// view waits, or after every second view.
VDBFUSE_API vdbfuse_status vdbfuse_scanner_correct_poses(vdbfuse_scanner* scanner, size_t count,
                                                         const uint64_t* ids,
                                                         const double* world_from_camera);
/// Waits until all that was pushed and corrected before is worked in.
VDBFUSE_API vdbfuse_status vdbfuse_scanner_wait(vdbfuse_scanner* scanner);
/// Set status->struct_size before.
VDBFUSE_API vdbfuse_status vdbfuse_scanner_get_status(const vdbfuse_scanner* scanner,
                                                      vdbfuse_scanner_status* status);
/// The whole preview as one mesh.
VDBFUSE_API vdbfuse_status vdbfuse_scanner_mesh(vdbfuse_scanner* scanner, vdbfuse_mesh** out);
/// The global cut of all views that were pushed. The scan may go on meanwhile and afterwards. `options` may
/// be NULL.
VDBFUSE_API vdbfuse_status vdbfuse_scanner_finish(vdbfuse_scanner* scanner,
                                                  const vdbfuse_fuse_options* options, vdbfuse_mesh** out);
VDBFUSE_API void vdbfuse_scanner_destroy(vdbfuse_scanner* scanner);

/// What changed of the preview since the last call: blocks of 32³ voxels to put in place of the ones of the
/// same origin, and blocks that have no surface any more.
VDBFUSE_API vdbfuse_status vdbfuse_scanner_preview(vdbfuse_scanner* scanner, vdbfuse_preview** out);
/// The latest view that the preview holds; 0: none.
VDBFUSE_API uint64_t vdbfuse_preview_newest(const vdbfuse_preview* preview);
VDBFUSE_API size_t vdbfuse_preview_changed_count(const vdbfuse_preview* preview);
/// A block's triangles, and in origin (3 numbers; may be NULL) its first voxel. NULL beyond the count.
VDBFUSE_API const vdbfuse_mesh* vdbfuse_preview_changed(const vdbfuse_preview* preview, size_t index,
                                                        int32_t* origin);
VDBFUSE_API size_t vdbfuse_preview_removed_count(const vdbfuse_preview* preview);
/// Three numbers for each removed block: its origin.
VDBFUSE_API const int32_t* vdbfuse_preview_removed(const vdbfuse_preview* preview);
VDBFUSE_API void vdbfuse_preview_destroy(vdbfuse_preview* preview);

#ifdef __cplusplus
}
#endif
// NOLINTEND(readability-identifier-naming)
