// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/module_volumes.h"

namespace nook
{
namespace
{

constexpr const char* kStages = R"(//
// Static ambient occlusion volumes of `nook volumes`, drawn over a frame's depth and normals: visibility of static surfaces, 1 where
// open. Four stages in one file, without #version, to be included after yours; say which one before:
//   #define NOOK_VERTEX    vertex stage of the volumes; with NOOK_PRISMS for files of --layout prisms
//   #define NOOK_FRAGMENT  their fragment stage
//   #define NOOK_RESOLVE   fragment stage over the picture: what was added up -> visibility
//   #define NOOK_SPARSE    only where one pixel of many is drawn: fragment stage over the whole picture, from nook_cells, the
//                          visibility of those; it discards pixels that they do not tell
// Each has its main(). nook_volumes.h reads the file, nook_volumes_draw.h fills the block and the clusters of a frame; both come with
// nook, are MIT, and need nothing else.
//
// Once: nook_volumes::Volumes::open. Upload corners() and polygons(): )";

constexpr const char* kOnce330 = R"(buffer textures nook_corners (RGBA16UI) and
// nook_polygons (RG32UI). With prisms, vertices() as well, as the attribute nook_point (location 1, four GL_UNSIGNED_SHORT, 8 bytes
// apart), and indices() as elements (GL_UNSIGNED_SHORT).
// Every frame: nook_volumes::Frame::set; its block is the uniform block NookVolumes; Frame::seen of every cluster makes the buffer
// texture nook_clusters (RGBA32UI, four texels a cluster).
)";

constexpr const char* kOnce430 = R"(storage buffers nook_corners and
// nook_polygons. With prisms, vertices() as well, as the attribute nook_point (location 1, four GL_UNSIGNED_SHORT, 8 bytes apart),
// and indices() as elements (GL_UNSIGNED_SHORT).
// Every frame: nook_volumes::Frame::set; its block is the uniform block NookVolumes; Frame::seen of every cluster makes the storage
// buffer nook_clusters.
)";

constexpr const char* kDrawing = R"(//
// Drawing, for each cluster i with Frame::inSight:
//   glVertexAttribI1i(0, i);
//   glDrawArrays(GL_TRIANGLES, 12 * first_corner, 12 * corner_count); // or, with prisms:
//   glDrawElementsBaseVertex(GL_TRIANGLES, index_count, GL_UNSIGNED_SHORT, 2 * first_index, first_vertex);
// or all in one call of glMultiDrawArraysIndirect (OpenGL 4.3), where nook_cluster (location 0) is an attribute with divisor 1 of the
// numbers 0, 1, 2 ..., and i the base instance.
// States: depth test against the frame's depth buffer, no depth writes; depth clamp; front faces counter-clockwise (clockwise where
// Frame::mirrored). Clusters that do not hold the eye: cull back faces, pass where nearer or equal. Those that do (Frame::holdsEye):
// cull front faces, pass where farther or equal. With EXT_depth_bounds_test, and a call a cluster: glDepthBoundsEXT of
// Frame::depthBounds spares the fragments of volumes that float between the eye and a surface.
// Fewer fragments: with NOOK_CHOOSE_FACES in the vertex stage draw all clusters in sight twice, with the first states and
// nook_faces = 1, then with the second ones and nook_faces = 2. Of each volume those faces are drawn that seem to cover fewer pixels
// in vain; the stage reads the depth in a few pixels for that (NOOK_DEPTH). Only for files with nook_volumes::kExactBounds: others
// are cut where they may still take light, and what is lost there depends on the faces.
)";

constexpr const char* kSums =
	R"(// Target: R16F (or R32F; R8 saturates at 1), cleared to 0, blended GL_ONE, GL_ONE. It is nook_sums of the resolve stage.
)";
constexpr const char* kBits =
	R"(// Target: unsigned integers, R32UI, RG32UI or RGBA32UI for up to 32, 64 and 128 directions, a second RGBA32UI for more; cleared to 0;
// no blending, but glEnable(GL_COLOR_LOGIC_OP), glLogicOp(GL_OR). They are nook_sums and nook_more_sums of the resolve stage.
)";
constexpr const char* kRest =
	R"(// With Camera::every above 1 the target has ceil(width / every) columns and as many rows; its depth buffer holds the depths of those
// pixels. nook_depths and nook_normals are always those of the whole picture. Then, over the whole picture, whose target has a stencil:
//   1. clear the stencil to 0; NOOK_SPARSE, with the same block, and the stencil set to 1 where it draws (GL_ALWAYS, GL_REPLACE);
//   2. for the pixels that it discarded (thin things, edges, sharp creases: about a tenth) all again, where the stencil is 0
//      (GL_EQUAL, GL_KEEP): the volumes into a target as large as the picture, with the block of a Frame whose Camera::every is 1
//      (nook_clusters stays as it is), then NOOK_RESOLVE into the picture of step 1.
// Beside a screen-space method: visibility = min(this, that); nothing that both see is darkened twice.
)";

} // namespace

std::string volumesGlsl(const AovTextSettings& settings, const EmitContext& context)
{
	const std::string version = settings.storage_buffers ? "430" : "330";
	return commentBlock(notesOf(context, {}), "// ") + kStages + (settings.storage_buffers ? kOnce430 : kOnce330) + kDrawing +
		   (settings.directions > 0 ? kBits : kSums) + kRest + "#if __VERSION__ < " + version +
		   "\n#error nook: this module needs #version " + version + " or later\n#endif\n" + aovText(settings);
}

} // namespace nook
