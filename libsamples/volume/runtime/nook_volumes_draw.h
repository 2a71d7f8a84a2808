// SPDX-License-Identifier: MIT
// Prepares a frame with the volumes of nook_volumes.h for the shaders of `nook emit --methods aov`: the uniform block, the position
// of each cluster relative to the eye, and which clusters to draw. C++17; needs only nook_volumes.h.
//
// Positions are relative to the eye, along the axes of the world; they are subtracted in 64 bits, so levels may be far from the
// origin.
#ifndef NOOK_VOLUMES_DRAW_H
#define NOOK_VOLUMES_DRAW_H

#include "nook_volumes.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace nook_volumes
{

// Matrices are in column-major order. camera_from_world must preserve lengths and angles (it may mirror); view space looks down −z.
// Any projection without a skew works: off-centre, orthographic, reversed, infinite, with an oblique near plane.
struct Camera
{
	double camera_from_world[16] = {};
	double projection[16] = {};
	int width = 0; // picture size, pixels
	int height = 0;
	double first_row_ndc_y = -1.0; // NDC y of the edge where row 0 of depths and normals lies: −1 in OpenGL and Vulkan; 1 in
								   // Direct3D, Metal and WebGPU, with a viewport of negative height in Vulkan, and in engines
								   // that draw OpenGL render targets upside down (OGRE). If the floor is black, flip it
	bool zero_to_one = false;   // NDC z runs from 0 to 1 (Vulkan, Direct3D, Metal, WebGPU); else from −1 to 1. For device depth
	bool faces_by_rows = false; // the API tells front faces with row 0 at the top (Vulkan, Direct3D, Metal, WebGPU); else with
								// NDC y upward, wherever row 0 is (OpenGL). For mirrored()
	double nearest = 0.0;       // lower bound of the depth of surfaces, metres along the view direction
	double farthest = std::numeric_limits<double>::infinity(); // upper bound of the depth of surfaces
	int every = 1; // draws one pixel per block of every × every, the one with the lowest row and column, into a picture of
				   // ceil(width / every) columns; nookSparse fills in the others
	double depth_step = 0.0;      // half a step of the depth buffer in metres, where clip-space w is 1
	double depth_share = 0x1p-22; // rounding error proportional to the depth, including the shaders' arithmetic
	double position_error = 0.0;  // other errors of positions, metres
	double bias = 0.0; // a receiver closer to the plane of a polygon is not occluded by it, metres; 0: 1e-4 of the distance of the
					   // volumes, or their plane_error
};

// The block `NookVolumes` in std140.
struct alignas(16) Block
{
	float size[2] = {};       // width, height in pixels
	float pixel_size[2] = {}; // 1/width, 1/height
	float across_x[2] = {};   // NDC to view space: 1 / P[0][0], P[2][0] / P[0][0]; likewise for y, and the offset
	float across_y[2] = {};
	float aside[2] = {};
	float w_slope = 0.0F;
	float w_start = 0.0F;
	float origin[2] = {};
	float far_end = 0.0F;
	std::int32_t cell = 0; // Camera::every
	float depth[4] = {};
	float depth_step = 0.0F;
	float depth_share = 0.0F;
	float position_error = 0.0F; // metres
	float radius = 0.0F;         // distance that volumes extend, metres
	float clip[16] = {};         // to clip space, from positions relative to the eye
	float right[4] = {};         // axes of the camera in the world
	float up[4] = {};
	float back[4] = {};
	float curve[36] = {};      // occlusion at its 33 knots
	float slope[4] = {};       // what NDC x, y add to depth[0], then to depth[2]; 0 except for oblique near planes
	float plane_bias = 0.0F;   // metres
	float exact_bounds = 0.0F; // 1: the file has kExactBounds
	float sum_range = 0.0F;    // last knot of the curve
};
static_assert(sizeof(Block) == 384, "std140");

// The data of a cluster for the shaders: four texels of RGBA32UI.
struct SeenCluster
{
	float offset[3]; // origin of corners, relative to the eye
	std::uint32_t first_polygon;
	float step[3];
	std::uint32_t first_corner;
	float vertex_offset[3]; // of prisms
	std::uint32_t first_vertex;
	float vertex_step[3];
	std::uint32_t unused;
};
static_assert(sizeof(SeenCluster) == 64, "four texels");

class Frame
{
public:
	// Returns null, or a short description of what is wrong with the camera.
	const char* set(const Header& volumes, const Camera& camera)
	{
		m_camera = camera;
		const double* const p = camera.projection;
		if (const char* const fault = faultOf(p))
		{
			return fault;
		}
		if (camera.width < 1 || camera.height < 1 || camera.every < 1)
		{
			return "a picture without pixels";
		}
		const double* const c = camera.camera_from_world;
		for (int i = 0; i < 3; ++i)
		{
			m_eye[i] = -(c[4 * i] * c[12] + c[4 * i + 1] * c[13] + c[4 * i + 2] * c[14]);
			block.right[i] = narrow(c[4 * i]);
			block.up[i] = narrow(c[4 * i + 1]);
			block.back[i] = narrow(c[4 * i + 2]);
		}
		for (int row = 0; row < 4; ++row)
		{
			for (int column = 0; column < 3; ++column)
			{
				m_clip[4 * column + row] = p[row] * c[4 * column] + p[4 + row] * c[4 * column + 1] + p[8 + row] * c[4 * column + 2];
			}
			m_clip[12 + row] = p[12 + row];
		}
		setClip();
		setCamera();
		setVolumes(volumes);
		return nullptr;
	}

	// The data of a cluster for this frame.
	SeenCluster seen(const Cluster& cluster) const
	{
		SeenCluster made = {};
		for (int i = 0; i < 3; ++i)
		{
			made.offset[i] = narrow(cluster.origin[i] - m_eye[i]);
			made.step[i] = cluster.step[i];
			made.vertex_offset[i] = narrow(cluster.vertex_origin[i] - m_eye[i]);
			made.vertex_step[i] = cluster.vertex_step[i];
		}
		made.first_polygon = cluster.first_polygon;
		made.first_corner = cluster.first_corner;
		made.first_vertex = cluster.first_vertex;
		return made;
	}

	// True if a cluster can occlude something in the picture. Checks the sides of the frustum, and the nearest and farthest
	// surface.
	bool inSight(const Cluster& cluster) const
	{
		// Clip space, with a relative margin of 1e-6 for rounding.
		const double* const m = m_clip;
		double planes[6][4];
		for (int i = 0; i < 4; ++i)
		{
			const double x = m[4 * i];
			const double y = m[4 * i + 1];
			const double w = m[4 * i + 3];
			planes[0][i] = w + x;
			planes[1][i] = w - x;
			planes[2][i] = w + y;
			planes[3][i] = w - y;
			const double depth = i < 3 ? -m_camera.camera_from_world[4 * i + 2] : 0.0;
			planes[4][i] = depth - (i == 3 ? m_camera.nearest : 0.0);
			planes[5][i] = (i == 3 ? m_camera.farthest : 0.0) - depth;
		}
		const int count = m_camera.farthest < std::numeric_limits<double>::infinity() ? 6 : 5;
		for (int plane = 0; plane < count; ++plane)
		{
			double most = planes[plane][3];
			double size = std::fabs(most);
			for (int i = 0; i < 3; ++i)
			{
				const double at = planes[plane][i] > 0.0 ? mostOf(cluster, i) : leastOf(cluster, i);
				most += planes[plane][i] * at;
				size += std::fabs(planes[plane][i] * at);
			}
			if (most < -1e-6 * size)
			{
				return false;
			}
		}
		return true;
	}

	// True if the eye is in the box of a cluster: then draw its back faces, else its front faces.
	bool holdsEye(const Cluster& cluster) const
	{
		for (int i = 0; i < 3; ++i)
		{
			const double least = leastOf(cluster, i);
			const double most = mostOf(cluster, i);
			const double slack = 1e-6 * (std::fabs(least) + std::fabs(most));
			if (least > slack || most < -slack)
			{
				return false;
			}
		}
		return true;
	}

	// Range of depth buffer values, 0 to 1, of the surfaces that a cluster can occlude: for glDepthBoundsEXT or
	// vkCmdSetDepthBounds, which skip the fragments of volumes that float in front of a surface.
	void depthBounds(const Cluster& cluster, double& least, double& most) const
	{
		const double* const p = m_camera.projection;
		const bool oblique = p[2] != 0.0 || p[6] != 0.0;
		least = 1.0;
		most = 0.0;
		// z/w has its extremes at corners of the box if these are in front of the eye; widened by 1e-5 of the distance.
		for (int side = 0; side < 16; ++side)
		{
			double z = m_clip[14];
			double w = m_clip[15];
			double distance = 0.0;
			for (int i = 0; i < 3; ++i)
			{
				const double at = (side >> i & 1) != 0 ? mostOf(cluster, i) : leastOf(cluster, i);
				z += m_clip[4 * i + 2] * at;
				w += m_clip[4 * i + 3] * at;
				distance += std::fabs(at);
			}
			const double slack = (side < 8 ? -1e-5 : 1e-5) * distance;
			z += slack * (-p[10] + (p[10] < 0.0 ? 1.0 : -1.0) * (std::fabs(p[2]) + std::fabs(p[6])));
			w += slack * -p[11];
			// Points behind the eye count as the near end of the depth buffer, unless the near plane is oblique.
			const bool before = w > 0.0;
			const double device = before ? (m_camera.zero_to_one ? z / w : 0.5 * z / w + 0.5) : m_near_end;
			least = before || !oblique ? std::fmin(least, device) : 0.0;
			most = before || !oblique ? std::fmax(most, device) : 1.0;
		}
		least = std::fmin(std::fmax(least - 1e-6, 0.0), 1.0);
		most = std::fmin(std::fmax(most + 1e-6, 0.0), 1.0);
	}

	// True if the picture is mirrored, so that front faces are clockwise.
	bool mirrored() const
	{
		const double* const c = m_camera.camera_from_world;
		const double turn =
			c[0] * (c[5] * c[10] - c[9] * c[6]) - c[4] * (c[1] * c[10] - c[9] * c[2]) + c[8] * (c[1] * c[6] - c[5] * c[2]);
		const bool in_ndc = (turn < 0.0) != (m_camera.projection[0] * m_camera.projection[5] < 0.0);
		return in_ndc != (m_camera.faces_by_rows && m_camera.first_row_ndc_y < 0.0);
	}

	Block block;

private:
	// True if w, given by the factors of x, y, z and 1, is that of a usual engine projection.
	static bool isUsualW(double x, double y, double z, double one)
	{
		const bool perspective = std::fabs(std::fabs(z) - 1.0) <= 1e-5 && one == 0.0;
		return x == 0.0 && y == 0.0 && (perspective || (z == 0.0 && one != 0.0));
	}

	// Returns null, or what is wrong with a projection.
	static const char* faultOf(const double* p)
	{
		for (int i = 0; i < 16; ++i)
		{
			if (!std::isfinite(p[i]))
			{
				return "a projection with infinity or NaN";
			}
		}
		if (!isUsualW(p[3], p[7], p[11], p[15]) && isUsualW(p[12], p[13], p[14], p[15]))
		{
			return "a projection that looks row-major: transpose it";
		}
		if (p[1] != 0.0 || p[4] != 0.0 || p[3] != 0.0 || p[7] != 0.0 || p[0] == 0.0 || p[5] == 0.0)
		{
			return "a projection with a skew";
		}
		if (p[11] > 0.0)
		{
			return "a projection that looks left-handed: w = +z; negate numbers 8 to 11, and z of camera_from_world and the "
				   "normals";
		}
		// Depths on the view axis at NDC z = 0 and 1 are p[14] / p[10] and above / below; only their signs matter.
		const double above = p[14] - p[15];
		const double below = p[10] - p[11];
		const bool behind = p[14] * p[10] <= 0.0 && above * below <= 0.0 && p[10] != 0.0 && below != 0.0;
		const bool no_w = p[11] == 0.0 && p[15] <= 0.0;
		return no_w || (behind && p[2] == 0.0 && p[6] == 0.0) ? "a projection that shows what is behind the camera: left-handed?"
															  : nullptr;
	}

	static float narrow(double value)
	{
		return static_cast<float>(value);
	}

	// Lower bound of a cluster's box relative to the eye, extended by how far one-sided volumes begin behind their planes.
	double leastOf(const Cluster& cluster, int axis) const
	{
		return cluster.origin[axis] + static_cast<double>(cluster.least[axis]) - m_eye[axis] - m_behind;
	}
	double mostOf(const Cluster& cluster, int axis) const
	{
		return cluster.origin[axis] + static_cast<double>(cluster.most[axis]) - m_eye[axis] + m_behind;
	}

	// Clip space of the render target: its pixel i is pixel i * every of the whole picture.
	void setClip()
	{
		for (int i = 0; i < 16; ++i)
		{
			block.clip[i] = narrow(m_clip[i]);
		}
		if (m_camera.every == 1)
		{
			return;
		}
		for (int axis = 0; axis < 2; ++axis)
		{
			const double pixels = axis == 0 ? m_camera.width : m_camera.height;
			const double every = m_camera.every;
			const double cells = std::ceil(pixels / every);
			const double scale = pixels / (every * cells);
			double shift = ((pixels - 1.0) / (2.0 * every) + 0.5) * 2.0 / cells - 1.0;
			shift = axis == 1 && m_camera.first_row_ndc_y > 0.0 ? -shift : shift;
			for (int column = 0; column < 4; ++column)
			{
				block.clip[4 * column + axis] = narrow(scale * m_clip[4 * column + axis] + shift * m_clip[4 * column + 3]);
			}
		}
	}

	void setCamera()
	{
		const double* const p = m_camera.projection;
		const double up = m_camera.first_row_ndc_y > 0.0 ? 1.0 : -1.0; // the shaders count rows from NDC y = 1
		block.size[0] = static_cast<float>(m_camera.width);
		block.size[1] = static_cast<float>(m_camera.height);
		block.pixel_size[0] = narrow(1.0 / m_camera.width);
		block.pixel_size[1] = narrow(1.0 / m_camera.height);
		for (int row = 0; row < 2; ++row)
		{
			float* const across = row == 0 ? block.across_x : block.across_y;
			across[0] = narrow((row == 0 ? 1.0 : up) / p[5 * row]);
			across[1] = narrow(p[8 + row] / p[5 * row]);
			block.aside[row] = narrow(-p[12 + row] / p[5 * row]);
		}
		// From w = wx * depth + wy and z = a * depth + b to the terms that convert device depth to linear depth. With an oblique
		// near plane, a and b are those at the centre of the picture, and NDC x and y add to them.
		const double wx = -p[11];
		const double wy = p[15];
		const double a = -p[10] + p[2] / p[0] * p[8] + p[6] / p[5] * p[9];
		const double b = p[14] - p[2] / p[0] * p[12] - p[6] / p[5] * p[13];
		const bool reversed = a * wy - b * wx < 0.0; // z/w decreases with depth everywhere in the picture
		const double far_end = reversed ? 0.0 : 1.0;
		const double scale = m_camera.zero_to_one ? 1.0 : 2.0;
		const double at = scale * far_end + (m_camera.zero_to_one ? 0.0 : -1.0);
		const double sign = reversed ? -1.0 : 1.0;
		m_near_end = 1.0 - far_end;
		block.w_slope = narrow(wx);
		block.w_start = narrow(wy);
		block.far_end = narrow(far_end);
		block.depth[0] = narrow(sign * (at * wy - b));
		block.depth[1] = narrow(-scale * wy);
		block.depth[2] = narrow(sign * (a - at * wx));
		block.depth[3] = narrow(scale * wx);
		for (int axis = 0; axis < 2; ++axis)
		{
			const double lean = (axis == 0 ? 1.0 : up) * sign * p[4 * axis + 2] / p[5 * axis];
			block.slope[axis] = narrow(-lean * wy);
			block.slope[2 + axis] = narrow(lean * wx);
		}
	}

	void setVolumes(const Header& volumes)
	{
		block.depth_step = narrow(m_camera.depth_step);
		block.depth_share = narrow(m_camera.depth_share);
		block.position_error = narrow(m_camera.position_error);
		block.cell = m_camera.every;
		block.radius = narrow(volumes.distance);
		const double bias = std::max(m_camera.bias > 0.0 ? m_camera.bias : 1e-4 * volumes.distance, volumes.plane_error);
		m_behind = 1.01 * (bias + m_camera.position_error); // nookBehind() of the shaders
		block.plane_bias = narrow(bias);
		block.exact_bounds = (volumes.flags & kExactBounds) != 0 ? 1.0F : 0.0F;
		block.sum_range = narrow(volumes.sum_range);
		for (std::size_t i = 0; i < kKnots; ++i)
		{
			block.curve[i] = narrow(volumes.occlusion[i]);
		}
	}

	Camera m_camera;
	double m_eye[3] = {};
	double m_clip[16] = {};
	double m_near_end = 0.0; // depth buffer value at its near end, 0 or 1
	double m_behind = 0.0;   // how far one-sided volumes begin behind their planes, metres
};

} // namespace nook_volumes

#endif
