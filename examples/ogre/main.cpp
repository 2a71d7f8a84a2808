// SPDX-License-Identifier: MIT
// OGRE draws a level with ambient obscurance from a module that nook emitted: frame.png. Also writes the module's picture,
// visibility0.tif, and what it read: depths, frame1.tif; normals, frame2.tif; and projection.txt, column by column.
#include <Ogre.h>

#include <nlohmann/json.hpp>
#include <ogre_ao.h> // nook: nook_fill and the tile

#include <fstream>
#include <iomanip>

namespace
{

constexpr int kWidth = 640;
constexpr int kHeight = 360;

// Reads the triangles of a file of `nook level`.
void loadLevel(Ogre::SceneManager& scene)
{
	using Json = nlohmann::json;
	std::ifstream file(MADE "/level.glb", std::ios::binary);
	const std::string bytes{std::istreambuf_iterator<char>(file), {}};
	const std::size_t data = bytes.find("BIN", 20) + 4;
	const Json json = Json::parse(bytes.substr(20, data - 28));
	const auto values = [&](const Json& index, auto kind)
	{
		const Json& accessor = json["accessors"][index.get<std::size_t>()];
		const Json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
		std::vector<decltype(kind)> result(accessor["count"].get<std::size_t>());
		const std::size_t start = view["byteOffset"].get<std::size_t>() + accessor["byteOffset"].get<std::size_t>();
		std::memcpy(result.data(), bytes.data() + data + start, result.size() * sizeof kind);
		return result;
	};
	Ogre::ManualObject& object = *scene.createManualObject();
	object.begin("level", Ogre::RenderOperation::OT_TRIANGLE_LIST, "engine");
	for (const Json& mesh : json["meshes"])
	{
		const Json& part = mesh["primitives"][0];
		const auto first = static_cast<Ogre::uint32>(object.getCurrentVertexCount());
		const auto positions = values(part["attributes"]["POSITION"], Ogre::Vector3f());
		const auto normals = values(part["attributes"]["NORMAL"], Ogre::Vector3f());
		for (std::size_t i = 0; i < positions.size(); ++i)
		{
			object.position(positions[i]);
			object.normal(normals[i]);
		}
		for (const Ogre::uint32 index : values(part["indices"], Ogre::uint32()))
		{
			object.index(first + index);
		}
	}
	object.end();
	scene.getRootSceneNode()->attachObject(&object);
}

// nook: the tile's samples, as the texture that nook.material names.
void loadTile()
{
	Ogre::DataStreamPtr texels(new Ogre::MemoryDataStream(const_cast<float(*)[4]>(nook_vo_line_tile), sizeof nook_vo_line_tile));
	Ogre::TextureManager::getSingleton().loadRawData("nook_vo_line_tile", "engine", texels, nook_vo_line_tile_width,
													 nook_vo_line_tile_height, Ogre::PF_FLOAT32_RGBA, Ogre::TEX_TYPE_2D, 0);
}

// nook: fills the uniform block. Call it again when the camera's projection or the size of the picture changes.
void fillBlock(const float (&projection)[16], double reach)
{
	nook_settings settings = nook_vo_line_settings(reach);
	settings.width = kWidth;
	settings.height = kHeight;
	settings.first_row_ndc_y = 1; // row 0 of OGRE's render targets is at the top
	nook_float_block block;
	if (const char* const reason = nook_fill(block, projection, settings))
	{
		OGRE_EXCEPT(Ogre::Exception::ERR_INVALIDPARAMS, reason);
	}
	const auto shared = Ogre::GpuProgramManager::getSingleton().getSharedParameters("nook_block");
	shared->setNamedConstant("nook", reinterpret_cast<const float*>(&block), sizeof block / sizeof(float));
}

} // namespace

int main()
{
	Ogre::Root root("", "", "ogre.log");
	root.loadPlugin(PLUGINS "/RenderSystem_GL3Plus");
	root.loadPlugin(PLUGINS "/Codec_FreeImage");
	root.setRenderSystem(root.getAvailableRenderers().front());
	root.initialise(false);
	Ogre::RenderWindow& window = *root.createRenderWindow("nook in OGRE", kWidth, kHeight, false);
	Ogre::ResourceGroupManager::getSingleton().addResourceLocation(MEDIA, "FileSystem", "engine");
	Ogre::ResourceGroupManager::getSingleton().addResourceLocation(MADE, "FileSystem", "engine");
	loadTile(); // nook
	Ogre::ResourceGroupManager::getSingleton().initialiseAllResourceGroups();
	Ogre::SceneManager& scene = *root.createSceneManager();
	loadLevel(scene);
	Ogre::Camera& camera = *scene.createCamera("camera");
	Ogre::SceneNode& eye = *scene.getRootSceneNode()->createChildSceneNode(Ogre::Vector3(2.6f, 1.7f, 0.6f));
	eye.attachObject(&camera);
	eye.setFixedYawAxis(true);
	eye.lookAt(Ogre::Vector3(-5.0f, 2.6f, -48.4f), Ogre::Node::TS_WORLD);
	camera.setFOVy(Ogre::Degree(62.0f));
	camera.setAspectRatio(static_cast<Ogre::Real>(kWidth) / kHeight);
	camera.setNearClipDistance(0.1f);
	float projection[16];                                                     // nook
	std::copy_n(camera.getProjectionMatrix().transpose()[0], 16, projection); // nook: OGRE stores matrices row by row
	fillBlock(projection, 1.5);                                               // nook
	auto& compositor = *Ogre::CompositorManager::getSingleton().addCompositor(window.addViewport(&camera), "nook");
	compositor.setEnabled(true);
	root.renderOneFrame();
	window.writeContentsToFile("frame.png");
	for (const auto& [texture, part] : std::multimap<std::string, std::size_t>{{"frame", 1}, {"frame", 2}, {"visibility", 0}})
	{
		Ogre::Image image;
		compositor.getTextureInstance(texture, part)->convertToImage(image);
		image.save(texture + std::to_string(part) + ".tif");
	}
	std::ofstream numbers("projection.txt");
	std::copy_n(projection, 16, std::ostream_iterator<float>(numbers << std::setprecision(9), " "));
}
