// SPDX-License-Identifier: Apache-2.0
// To and from the types of the Point Cloud Library (link vdbfuse::pcl). Lengths are not changed. An organised
// cloud holds points in the sensor's frame (x right, y down, z forward); sensor_origin_ and
// sensor_orientation_ are world_from_camera, as pcl_viewer and pcl_transform_from_viewpoint take them.
#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include "vdbfuse/mesh/triangle_mesh.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse {

/// An organised cloud of the view's size; NaN where the depth is invalid (is_dense says whether there is
/// any).
pcl::PointCloud<pcl::PointXYZ> toPointCloud(const View& view);

/// The view of an organised cloud taken by an undistorted pinhole camera, which is found by fitPinhole().
/// Throws InvalidArgument when the cloud is not organised, when its orientation is no rotation, or as
/// fitPinhole() does.
View toView(const pcl::PointCloud<pcl::PointXYZ>& cloud);

/// The same for a sensor that is known.
View toView(const pcl::PointCloud<pcl::PointXYZ>& cloud, const Projection& projection);

/// Vertices with x, y, z, and what else there is of normal_x, normal_y, normal_z and rgb; support is left
/// out.
pcl::PolygonMesh toPolygonMesh(const TriangleMesh& mesh);

/// The inverse; polygons with more corners become fans. Throws InvalidArgument when there is no x, y, z, when
/// a polygon has fewer than three corners, or when an index is out of range.
TriangleMesh toTriangleMesh(const pcl::PolygonMesh& mesh);

}  // namespace vdbfuse
