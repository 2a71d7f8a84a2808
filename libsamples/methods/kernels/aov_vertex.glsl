// SPDX-License-Identifier: MIT
// Vertex stage of the volumes: from the integers of the file to a vertex of the volume of a polygon (AOV section 5.2).

// Unit normal of the front of a polygon, from its area vector.
vec3 nookFrontOf(int first, int count)
{
	vec3 start = vec3(nookPackedCorner(first).xyz);
	vec3 before = nook_step * (vec3(nookPackedCorner(first + 1).xyz) - start);
	vec3 sum = vec3(0.0, 0.0, 0.0);
	for (int i = 2; i < count; ++i)
	{
		vec3 after = nook_step * (vec3(nookPackedCorner(first + i).xyz) - start);
		sum += nookCross(before, after);
		before = after;
	}
	float most = max(max(abs(sum.x), abs(sum.y)), max(abs(sum.z), 1e-37));
	return normalize(sum / most);
}

// How far a corner moves outward in the plane of the polygon, between an arriving and a leaving edge, which are unit vectors
// (AOV eqs. 9 to 11 in closed form); limited to `most`.
vec3 nookExtension(vec3 arriving, vec3 leaving, vec3 front, float reach, float most)
{
	float cosine = dot(arriving, leaving);
	if (cosine >= 0.0)
	{
		return cross(arriving + leaving, front) * (reach / (1.0 + cosine));
	}
	vec3 outward = arriving - leaving;
	float size = length(outward);
	float sine = dot(nookCross(arriving, leaving), front);
	return outward / size * (sine > reach * size / most ? reach * size / sine : most);
}

// How far the volume of a one-sided polygon begins behind its plane, metres: receivers there may be lifted into the volume.
float nookBehind()
{
	return 1.01 * (nook.plane_bias + nook.position_error);
}

// Corner i of the volume in its lower ring (ring 0) or its upper one (ring 1).
vec3 nookPrismPoint(int i, int ring)
{
	int first = nook_polygon.x;
	int count = nook_polygon.y;
	vec3 front = nook_front.xyz;
	vec3 here = vec3(nookPackedCorner(first + i).xyz);
	vec3 arriving = normalize(nook_step * (here - vec3(nookPackedCorner(first + (i + count - 1) % count).xyz)));
	vec3 leaving = normalize(nook_step * (vec3(nookPackedCorner(first + (i + 1) % count).xyz) - here));
	vec2 goes = nook.radius * nookShare();
	float reach = goes.y;
	float most = 2.0 * reach; // the clamp of AOV
	if (nook.exact_bounds > 0.5)
	{
		float longest = 4.0 * reach;
		vec3 before = vec3(nookPackedCorner(first + count - 1).xyz);
		for (int k = 0; k < count; ++k)
		{
			vec3 after = vec3(nookPackedCorner(first + k).xyz);
			longest = max(longest, length(nook_step * (after - before)));
			before = after;
		}
		most = 64.0 * longest;
	}
	float height = ring > 0 ? goes.x : nook_polygon.z > 0 ? -goes.x : -nookBehind();
	return nook_offset + nook_step * here + nookExtension(arriving, leaving, front, reach, most) + height * front;
}

// Fetches what all vertices of a polygon share. polygon: its number in the cluster.
void nookSetPolygon(int cluster, int polygon)
{
	uvec4 first = nookSeenCluster(cluster, 0);
	uvec4 second = nookSeenCluster(cluster, 1);
	nook_offset = uintBitsToFloat(first.xyz);
	nook_step = uintBitsToFloat(second.xyz);
	uvec2 own = nookPackedPolygon(int(first.w) + polygon);
	int reaches = 128 - int((own.y >> 9) & 127u) + 256 * (8 - int((own.y >> 5) & 7u));
	nook_polygon = ivec4(int(own.x), int(own.y & 31u), int((own.y >> 8) & 1u), reaches);
	nook_front = vec4(nookFrontOf(nook_polygon.x, nook_polygon.y), float(own.y >> 16) / 65535.0);
}

// Layout polygons. Each corner has twelve vertices: two triangles of the side that its edge makes, one triangle of the lower
// face and one of the upper face.
vec4 nookPolygonVertex(int cluster, int vertex)
{
	int corner = vertex / 12;
	int part = vertex % 12;
	nookSetPolygon(cluster, int(nookPackedCorner(corner).w));
#ifdef NOOK_CHOOSE_FACES
	if (!nookIsAsked())
	{
		return vec4(2.0, 2.0, 2.0, 1.0); // outside the picture, as all vertices of this polygon: nothing is drawn
	}
#endif
	int i = corner - nook_polygon.x;
	int next = i + 1 < nook_polygon.y ? i + 1 : 0;
	int at = part == 6 || part == 9 ? 0 : part == 0 || part == 3 || part == 5 || part == 8 || part == 10 ? i : next;
	int ring = part == 2 || part == 4 || part == 5 || part > 8 ? 1 : 0;
	return nook.clip * vec4(nookPrismPoint(at, ring), 1.0);
}

// Layout prisms: a vertex of the file.
vec4 nookPrismVertex(int cluster, uvec4 point)
{
	nookSetPolygon(cluster, int(point.w));
#ifdef NOOK_CHOOSE_FACES
	if (!nookIsAsked())
	{
		return vec4(2.0, 2.0, 2.0, 1.0); // outside the picture, as all vertices of this polygon: nothing is drawn
	}
#endif
	vec3 offset = uintBitsToFloat(nookSeenCluster(cluster, 2).xyz);
	vec3 step = uintBitsToFloat(nookSeenCluster(cluster, 3).xyz);
	vec3 at = offset + step * vec3(point.xyz);
	vec3 corner = nook_offset + nook_step * vec3(nookPackedCorner(nook_polygon.x).xyz);
	bool lower = nook_polygon.z == 0 && dot(nook_front.xyz, at - corner) < 0.5 * nook.radius * nookShare().x;
	return nook.clip * vec4(at - (lower ? nookBehind() : 0.0) * nook_front.xyz, 1.0);
}
