// SPDX-License-Identifier: MIT
// Vertex stage: decides which volumes are drawn by their front faces, and which by their back faces. Front faces also cover
// pixels whose surface lies behind the whole volume, back faces also those whose surface lies in front of it. Neither occludes
// these surfaces, so the better choice is the one that covers fewer of them.

// Is the surface in the picture behind a point (1), before it (-1), or is that unknown (0)? The point is relative to the eye,
// along the axes of the world.
int nookSurfaceAt(vec3 point)
{
	float depth = -dot(nook.back.xyz, point);
	float w = nook.w_slope * depth + nook.w_start;
	if (w <= 0.0 || depth <= 0.0)
	{
		return 0;
	}
	// The inverse of nookPosition.
	float x = (dot(nook.right.xyz, point) - depth * nook.across_x.y - nook.aside.x) / (w * nook.across_x.x);
	float y = (dot(nook.up.xyz, point) - depth * nook.across_y.y - nook.aside.y) / (w * nook.across_y.x);
	vec2 place = clamp(vec2(x + 1.0, 1.0 - y) * 0.5, vec2(0.0, 0.0), vec2(1.0, 1.0)) * nook.size + nook.origin;
	return nookDepth(ivec2(min(place, nook.size + nook.origin - 1.0))) > depth ? 1 : -1;
}

// Is the volume better drawn by its back faces? Requires nookSetPolygon. Yes where the eye may be in the volume, because it
// then has no front faces before the eye; otherwise the surfaces at points halfway between the centre of the volume and its
// corners decide, two for each corner of the polygon.
bool nookBackFaces()
{
	int first = nook_polygon.x;
	int count = nook_polygon.y;
	vec3 front = nook_front.xyz;
	float reach = nook.radius * nookShare().x;
	float side = nook.radius * nookShare().y;
	float low = nook_polygon.z > 0 ? -reach : 0.0;
	vec3 a = nook_offset + nook_step * vec3(nookPackedCorner(first + count - 1).xyz);
	float slack = 1e-3 * reach + 1e-5 * length(a);
	float height = -dot(front, a);
	bool outside = height > reach + slack || height < low - slack;
	vec3 middle = vec3(0.0, 0.0, 0.0);
	for (int i = 0; i < count; ++i)
	{
		vec3 b = nook_offset + nook_step * vec3(nookPackedCorner(first + i).xyz);
		vec3 inward = cross(front, b - a);
		outside = outside || dot(a, inward) > (side + slack) * length(inward);
		middle += b / float(count);
		a = b;
	}
	if (!outside)
	{
		return true;
	}
	vec3 upper = front * (0.25 * (reach - low));
	vec3 centre = middle + front * (0.5 * (reach + low));
	int behind = 0;
	for (int i = 0; i < count; ++i)
	{
		vec3 out_of = nook_offset + nook_step * vec3(nookPackedCorner(first + i).xyz) - middle;
		vec3 point = centre + out_of * (0.5 + 0.5 * side / max(length(out_of), 1e-30));
		behind += nookSurfaceAt(point - upper) + nookSurfaceAt(point + upper);
	}
	return behind > 0;
}

// Does nook_faces ask for the volume of this polygon?
bool nookIsAsked()
{
	return nook_faces == 0 || nookBackFaces() == (nook_faces == 2);
}
