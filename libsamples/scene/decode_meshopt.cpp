// SPDX-License-Identifier: GPL-3.0-or-later
// Part of the level worker: decodes buffer views of EXT_meshopt_compression with meshoptimizer.
#include "scene/mesh_codec.h"

#include "core/file.h"
#include "core/words.h"

#include <meshoptimizer.h>

#include <string>
#include <vector>

namespace nook
{
namespace
{

bool decodeView(const MeshoptView& view, const std::vector<unsigned char>& coded, std::vector<char>& bytes)
{
	const auto count = static_cast<std::size_t>(view.count);
	const auto stride = static_cast<std::size_t>(view.stride);
	bytes.resize(count * stride);
	switch (view.mode)
	{
	case MeshoptView::Mode::attributes:
		return meshopt_decodeVertexBuffer(bytes.data(), count, stride, coded.data(), coded.size()) == 0;
	case MeshoptView::Mode::triangles:
		return meshopt_decodeIndexBuffer(bytes.data(), count, stride, coded.data(), coded.size()) == 0;
	case MeshoptView::Mode::indices:
		return meshopt_decodeIndexSequence(bytes.data(), count, stride, coded.data(), coded.size()) == 0;
	}
	return false;
}

void applyFilter(const MeshoptView& view, std::vector<char>& bytes)
{
	const auto count = static_cast<std::size_t>(view.count);
	const auto stride = static_cast<std::size_t>(view.stride);
	switch (view.filter)
	{
	case MeshoptView::Filter::octahedral: meshopt_decodeFilterOct(bytes.data(), count, stride); break;
	case MeshoptView::Filter::quaternion: meshopt_decodeFilterQuat(bytes.data(), count, stride); break;
	case MeshoptView::Filter::exponential: meshopt_decodeFilterExp(bytes.data(), count, stride); break;
	case MeshoptView::Filter::none: break;
	}
}

} // namespace

void decodeMeshopt(ValueReader& request, ValueWriter& answer)
{
	const std::string name = request.text();
	std::vector<MeshoptView> views(request.value<uint64_t>());
	std::vector<std::vector<unsigned char>> coded(views.size());
	for (std::size_t i = 0; i < views.size(); ++i)
	{
		views[i] = request.value<MeshoptView>();
		request.values(coded[i], kMaxFileBytes);
	}
	std::vector<char> bytes;
	for (std::size_t i = 0; i < views.size(); ++i)
	{
		if (!decodeView(views[i], coded[i], bytes))
		{
			refuseInput(name + ": bufferViews[" + std::to_string(views[i].index) + "].extensions.EXT_meshopt_compression",
						"bytes that do not decode",
						std::to_string(views[i].count) + " elements of " + std::to_string(views[i].stride) + " bytes");
		}
		applyFilter(views[i], bytes);
		answer.values(bytes);
		std::vector<unsigned char>().swap(coded[i]);
	}
}

} // namespace nook
