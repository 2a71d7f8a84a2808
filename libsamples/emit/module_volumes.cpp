// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/module.h"

namespace nook
{
namespace
{

constexpr const char* kStages = R"(//
// Draws the static ambient occlusion volumes of a file that `nook volumes` wrote over the depth and normals of a frame: visibility of
// static surfaces, 1 where open. Four stages are in this one file. It has no #version: include it after yours, and define one of these
// first:
//   #define NOOK_VERTEX    vertex stage of the volumes; with NOOK_PRISMS for files of --layout prisms
//   #define NOOK_FRAGMENT  fragment stage of the volumes; one depth read per fragment
//   #define NOOK_RESOLVE   fragment stage over the picture, from the sums of the volumes to visibility; no depth reads
//   #define NOOK_SPARSE    only where Camera::every is above 1: fragment stage over the whole picture, which interpolates the visibility
//                          of the drawn pixels, nook_cells, and discards pixels for which they are no good; at most 51 depth reads
// Each stage has its main(). nook_volumes.h reads the file, nook_volumes_draw.h fills the uniform block and the clusters of a frame.
// Both headers come with nook, are MIT, and have no dependencies.
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
// States: depth test against the depth buffer of the frame, no depth writes; depth clamp; front faces counter-clockwise (clockwise where
// Frame::mirrored). Clusters that do not contain the eye: cull back faces, depth test "less or equal". Clusters that do
// (Frame::holdsEye): cull front faces, depth test "greater or equal"; reversed depth has the opposite tests. With EXT_depth_bounds_test
// and one call per cluster, glDepthBoundsEXT with Frame::depthBounds skips fragments of volumes that float between the eye and a surface.
// Fewer fragments: define NOOK_CHOOSE_FACES for the vertex stage and draw all clusters in sight twice, first with the states of clusters
// that do not contain the eye and nook_faces = 1, then with the other states and nook_faces = 2. Each volume is then drawn by the faces,
// front or back, that seem to cover fewer pixels without any effect; to decide, the vertex stage reads two depths per corner of the
// polygon (NOOK_DEPTH). This is only for files with nook_volumes::kExactBounds: other volumes are cut off where they may still occlude
// a little, and which part is lost depends on the faces.
)";

constexpr const char* kSums =
	R"(// Target: R16F (or R32F; R8 would saturate at 1), cleared to 0, blended with GL_ONE, GL_ONE. The resolve stage reads it as nook_sums.
)";
constexpr const char* kBits =
	R"(// Target: unsigned integers, R32UI, RG32UI or RGBA32UI for up to 32, 64 and 128 directions, a second RGBA32UI for more; cleared to 0;
// no blending, but glEnable(GL_COLOR_LOGIC_OP), glLogicOp(GL_OR). The resolve stage reads them as nook_sums and nook_more_sums.
// Once, before the first frame: draw a triangle over a texture RGBA32UI of 64 x 64 texels, 64 x 128 above 128 directions, with a
// fragment stage that defines NOOK_HALF_SPACES. The fragment stage of the volumes reads it as nook_half_spaces.
)";
constexpr const char* kRest =
	R"(// With Camera::every above 1 only one pixel of every x every is drawn: the target has ceil(width / every) columns and
// ceil(height / every) rows, and its depth buffer holds the depths of those pixels. nook_depths and nook_normals always are those of the
// whole picture. After NOOK_RESOLVE, fill the whole picture, whose target has a stencil buffer:
//   1. Clear the stencil to 0. Draw NOOK_SPARSE with the same block; it sets the stencil to 1 where it draws (GL_ALWAYS, GL_REPLACE).
//   2. It discards about a tenth of the pixels: thin objects, edges, sharp creases. Draw these where the stencil is 0 (GL_EQUAL,
//      GL_KEEP): the volumes into a target of the size of the picture, with the block of a Frame whose Camera::every is 1
//      (nook_clusters stays as it is), then NOOK_RESOLVE into the picture of step 1.
// Together with a screen-space method, take min(this visibility, that one): then an occluder that both see counts once.
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
