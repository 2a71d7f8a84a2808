// SPDX-License-Identifier: MIT
// Shows a level with ambient obscurance from shaders that nook generated during the build.
#include "platform.h"
#include "scene.h"

#include <epoxy/gl.h>
#include <glm/gtc/matrix_transform.hpp>
#include <png.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>

namespace
{

std::string helpText()
{
	const std::vector<Obscurance::Method>& methods = Obscurance::methods();
	std::string names;
	for (std::size_t i = 0; i < methods.size(); ++i)
	{
		names += (i == 0 ? "" : i + 1 == methods.size() ? " or " : ", ") + std::string(methods[i].name);
	}
	return "usage: viewer [LEVEL.glb] [options]\n"
		   "  LEVEL.glb        a file of `nook level` or `nook bake` (default: that of builtin:courtyard)\n"
		   "  --no-window      draws without a display (EGL)\n"
		   "  --size WxH       of the picture (default 1280x720)\n"
		   "  --camera NAME    of the level (default: its first)\n"
		   "  --method NAME    " +
		   names +
		   "\n"
		   "  --resolution R   of the obscurance: full (default) or half\n"
		   "  --show WHAT      lit, visibility, depth, normals, difference (half - full resolution, times 4, grey where there is\n"
		   "                   none), or ages: how many frames a pixel's mean is of, white from ten\n"
		   "  --accumulate A   the mean over frames: off (default), on, or unchecked: history of any surface, which leaves ghosts\n"
		   "  --tile T         what the mean is of: frames (default): other samples each frame, or still: the same ones\n"
		   "  --motion M       of the camera, each picture: still (default), pan half a degree, or walk 5 cm to the right\n"
		   "  --occluder WHAT  screen (default: the method), volumes, both: the lesser of the two visibilities, bake: what the\n"
		   "                   level's vertices know, or moves: bake or volumes, and the method for what moves\n"
		   "  --moving FILE    of `nook level`: what moves\n"
		   "  --volumes FILE   of `nook volumes` (default: those of builtin:courtyard)\n"
		   "  --radius METRES  of the obscurance (default 0.5)\n"
		   "  --keys KEYS      as if pressed, one after each picture\n"
		   "  --frames N       pictures before the end (default: no end; without a window until all keys are pressed)\n"
		   "  -o FILE.png      the last picture\n"
		   "keys: 1 to " +
		   std::to_string(methods.size()) +
		   " method, r resolution, o what darkens, v what is shown, z reversed depth, c next camera,\n"
		   "      t mean over frames, f tile, m motion, x forgets all frames; W A S D Q E and the mouse move, shift is faster;\n"
		   "      escape ends\n"
		   "exit codes: 0 ok, 1 usage, 2 file, 3 invalid input, 4 failed at run time, 5 not supported\n";
}

constexpr std::array<const char*, 6> kShow{"lit", "visibility", "depth", "normals", "difference", "ages"};
constexpr std::array<const char*, 5> kOccluders{"screen", "both", "volumes", "bake", "moves"};
constexpr std::array<const char*, 2> kResolutions{"full", "half"};
constexpr std::array<const char*, 3> kAccumulate{"off", "on", "unchecked"};
constexpr std::array<const char*, 2> kTiles{"frames", "still"};
constexpr std::array<const char*, 3> kMotions{"still", "pan", "walk"};

// Frames drawn for timing; the second to last counts, because in the first the driver compiles shaders.
constexpr int kTimedPictures = 3;

// Camera motion per frame at 60 Hz: 30 degrees per second, and 3 m per second as with W A S D.
constexpr float kTurn = 0.004f; // radians per pixel of mouse movement
const std::array<Platform::Motion, 3> kSteps{
	{{}, {{0.0f, 0.0f, 0.0f}, {glm::radians(0.5f) / kTurn, 0.0f}}, {{0.05f, 0.0f, 0.0f}, {0.0f, 0.0f}}}};

struct Options
{
	std::string level = VIEWER_LEVEL;
	std::string volumes = VIEWER_VOLUMES;
	std::string moving;
	bool own_volumes = false; // from --volumes
	bool other_level = false; // not the level of the volumes
	glm::ivec2 size{1280, 720};
	std::string camera;
	Settings settings;
	std::size_t motion = 0; // index into kMotions
	std::string keys;
	int frames = 0;
	bool window = true;
	std::string output;
};

[[noreturn]] void refuse(const std::string& option, const std::string& found, const std::string& expected)
{
	throw Failure(1, option + ": found '" + found + "', expected " + expected);
}

int wholeOf(const std::string& option, const std::string& text, const std::string& expected)
{
	char* end = nullptr;
	const long value = std::strtol(text.c_str(), &end, 10);
	if (text.empty() || *end != '\0' || value < 1 || value > 16384)
	{
		refuse(option, text, expected);
	}
	return static_cast<int>(value);
}

// Index of an option's value in a list of names.
template <class Names, class NameOf>
std::size_t chosen(const std::string& option, const std::string& value, const Names& names, NameOf nameOf)
{
	std::string known;
	for (std::size_t i = 0; i < names.size(); ++i)
	{
		if (value == nameOf(names[i]))
		{
			return i;
		}
		known += (i == 0 ? "" : ", ") + std::string(nameOf(names[i]));
	}
	refuse(option, value, "one of " + known);
}

const char* plainName(const char* name)
{
	return name;
}

void take(Options& options, const std::string& option, const std::string& value)
{
	if (option == "--size")
	{
		const std::size_t x = value.find('x');
		options.size.x = wholeOf(option, value.substr(0, x), "WIDTHxHEIGHT");
		options.size.y = wholeOf(option, x == std::string::npos ? "" : value.substr(x + 1), "WIDTHxHEIGHT");
	}
	else if (option == "--camera")
	{
		options.camera = value;
	}
	else if (option == "--method")
	{
		options.settings.method = chosen(option, value, Obscurance::methods(), [](const auto& method) { return method.name; });
	}
	else if (option == "--resolution")
	{
		options.settings.half = chosen(option, value, kResolutions, plainName) == 1;
	}
	else if (option == "--occluder")
	{
		options.settings.occluder = static_cast<Occluder>(chosen(option, value, kOccluders, plainName));
	}
	else if (option == "--accumulate")
	{
		options.settings.accumulate = static_cast<Accumulate>(chosen(option, value, kAccumulate, plainName));
	}
	else if (option == "--tile")
	{
		options.settings.still_tile = chosen(option, value, kTiles, plainName) == 1;
	}
	else if (option == "--motion")
	{
		options.motion = chosen(option, value, kMotions, plainName);
	}
	else if (option == "--moving")
	{
		options.moving = value;
	}
	else if (option == "--volumes")
	{
		options.volumes = value;
		options.own_volumes = true;
	}
	else if (option == "--show")
	{
		options.settings.show = static_cast<Show>(chosen(option, value, kShow, plainName));
	}
	else if (option == "--radius")
	{
		char* end = nullptr;
		options.settings.radius_m = std::strtof(value.c_str(), &end);
		if (value.empty() || *end != '\0' || !(options.settings.radius_m > 0.0f && options.settings.radius_m < 1e6f))
		{
			refuse(option, value, "metres above 0");
		}
	}
	else if (option == "--keys")
	{
		options.keys = value;
		options.keys.erase(std::remove(options.keys.begin(), options.keys.end(), ' '), options.keys.end());
	}
	else if (option == "--frames")
	{
		options.frames = wholeOf(option, value, "a number from 1 to 16384");
	}
	else if (option == "-o")
	{
		options.output = value;
	}
	else
	{
		throw Failure(1, option + ": not an option, expected what --help lists");
	}
}

Options optionsOf(int argc, char** argv)
{
	Options options;
	for (int i = 1; i < argc; ++i)
	{
		const std::string option = argv[i];
		if (option == "--no-window")
		{
			options.window = false;
		}
		else if (option[0] != '-')
		{
			options.level = option;
			options.other_level = true;
		}
		else
		{
			take(options, option,
				 i + 1 < argc ? argv[i + 1] : throw Failure(1, option + ": found nothing after it, expected a value"));
			++i;
		}
	}
	options.other_level = options.other_level && !options.own_volumes;
	return options;
}

void savePicture(const std::string& path, glm::ivec2 size, const std::vector<std::uint8_t>& rgb)
{
	png_image png{};
	png.version = PNG_IMAGE_VERSION;
	png.width = static_cast<png_uint_32>(size.x);
	png.height = static_cast<png_uint_32>(size.y);
	png.format = PNG_FORMAT_RGB;
	if (png_image_write_to_file(&png, path.c_str(), 0, rgb.data(), 0, nullptr) == 0)
	{
		throw Failure(2, path + ": cannot be written: " + png.message);
	}
}

class Viewer
{
public:
	explicit Viewer(const Options& options)
		: m_options(options), m_settings(options.settings), m_motion(options.motion), m_level(readLevel(options.level))
	{
		const auto named = [&](const Camera& camera)
		{
			return options.camera.empty() || camera.name == options.camera;
		};
		const auto found = std::find_if(m_level.cameras.begin(), m_level.cameras.end(), named);
		if (found == m_level.cameras.end())
		{
			refuse("--camera", options.camera, "one of the level, as nook info lists them");
		}
		m_camera_index = static_cast<std::size_t>(found - m_level.cameras.begin());
		m_camera = *found;
		if (!isAtHand(m_settings.occluder))
		{
			throw Failure(1, "--occluder: found nothing of the level to draw it by, expected --volumes FILE, made of " +
								 options.level + ", or a level of `nook bake`");
		}
		if (!options.moving.empty())
		{
			addMoving(m_level, readLevel(options.moving));
		}
		m_platform = options.window ? openWindow(options.size, [this](char key) { onKey(key); }) : openWithoutWindow(options.size);
		m_scene.emplace(m_level, options.volumes);
	}

	void run()
	{
		const int pressed = static_cast<int>(m_options.keys.size());
		const int frames = std::max(m_options.frames, m_options.window && m_options.frames == 0 ? 0 : pressed + 1);
		std::string title;
		for (int frame = 0; m_platform->isOpen() && (frames == 0 || frame < frames); ++frame)
		{
			if (frame > 0 && frame <= pressed)
			{
				onKey(m_options.keys[static_cast<std::size_t>(frame - 1)]);
			}
			move(m_platform->takeMotion());
			if (frame > 0)
			{
				move(kSteps[m_motion]);
			}
			m_size = m_platform->size();
			// Without a window only the last frame is seen, unless frames are accumulated.
			if (m_platform->isWindow() || m_settings.accumulates() || frame + kTimedPictures >= frames)
			{
				m_scene->resize(m_size.x, m_size.y);
				m_scene->draw(m_camera, m_settings);
				title = state();
			}
			if (m_platform->isWindow())
			{
				m_scene->blitTo(0, m_size.x, m_size.y);
			}
			m_platform->present("nook viewer: " + title);
		}
		if (!m_options.output.empty())
		{
			savePicture(m_options.output, m_size, m_scene->pixels());
		}
		std::printf("%s (%s)\n", title.c_str(), reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
	}

private:
	void onKey(char key)
	{
		if (key == 'v')
		{
			m_settings.show = static_cast<Show>((static_cast<std::size_t>(m_settings.show) + 1) % kShow.size());
		}
		else if (key == 'o')
		{
			do
			{
				m_settings.occluder =
					static_cast<Occluder>((static_cast<std::size_t>(m_settings.occluder) + 1) % kOccluders.size());
			} while (!isAtHand(m_settings.occluder));
		}
		else if (key == 'm')
		{
			m_motion = (m_motion + 1) % kMotions.size();
		}
		else
		{
			onCut(key);
		}
	}

	// True if the required volumes and vertex values are available.
	bool isAtHand(Occluder occluder) const
	{
		const bool volumes = !m_options.other_level;
		const bool baked = m_level.baked == Baked::visibility || (m_level.baked == Baked::difference && volumes);
		switch (occluder)
		{
		case Occluder::screen: return true;
		case Occluder::bake: return baked;
		case Occluder::moves: return baked || volumes;
		default: return volumes;
		}
	}

	// Keys that invalidate previous frames.
	void onCut(char key)
	{
		const auto method = static_cast<std::size_t>(key - '1');
		if (method < Obscurance::methods().size())
		{
			m_settings.method = method;
		}
		else if (key == 'r')
		{
			m_settings.half = !m_settings.half;
		}
		else if (key == 'z')
		{
			m_settings.reversed = !m_settings.reversed;
		}
		else if (key == 'c')
		{
			m_camera_index = (m_camera_index + 1) % m_level.cameras.size();
			m_camera = m_level.cameras[m_camera_index];
		}
		else if (key == 't')
		{
			m_settings.accumulate =
				static_cast<Accumulate>((static_cast<std::size_t>(m_settings.accumulate) + 1) % kAccumulate.size());
		}
		else if (key == 'f')
		{
			m_settings.still_tile = !m_settings.still_tile;
		}
		else if (key != 'x')
		{
			return;
		}
		m_scene->cut();
	}

	void move(const Platform::Motion& motion)
	{
		glm::mat4& camera = m_camera.world_from_camera;
		const glm::vec4 eye = camera * glm::vec4(motion.step_m, 1.0f);
		camera[3] = {0.0f, 0.0f, 0.0f, 1.0f};
		camera = glm::rotate(glm::mat4(1.0f), -kTurn * motion.turn_px.x, {0.0f, 1.0f, 0.0f}) * camera;
		camera = glm::rotate(camera, -kTurn * motion.turn_px.y, {1.0f, 0.0f, 0.0f});
		camera[3] = eye;
	}

	// Text for the window title.
	std::string state() const
	{
		std::array<char, 64> time{};
		std::snprintf(time.data(), time.size(), "%.2f ms", m_scene->milliseconds());
		const std::string mean = std::string(", mean ") + kAccumulate[static_cast<std::size_t>(m_settings.accumulate)] + ", tile " +
								 kTiles[m_settings.still_tile ? 1 : 0];
		return std::string(Obscurance::methods()[m_settings.method].name) + (m_settings.half ? ", half resolution, " : ", ") +
			   kOccluders[static_cast<std::size_t>(m_settings.occluder)] + ", " + kShow[static_cast<std::size_t>(m_settings.show)] +
			   (m_settings.accumulate == Accumulate::off ? "" : mean) + (m_settings.reversed ? ", reversed depth, " : ", ") +
			   m_camera.name + ", " + time.data();
	}

	Options m_options;
	Settings m_settings;
	std::size_t m_motion = 0;
	LevelFile m_level;
	std::size_t m_camera_index = 0;
	Camera m_camera;
	glm::ivec2 m_size{0};
	std::unique_ptr<Platform> m_platform; // declared before the scene, whose OpenGL objects live in its context
	std::optional<Scene> m_scene;
};

} // namespace

int main(int argc, char** argv)
{
	try
	{
		if (argc == 2 && (std::string(argv[1]) == "--help" || std::string(argv[1]) == "-h"))
		{
			std::fputs(helpText().c_str(), stdout);
			return 0;
		}
		Viewer(optionsOf(argc, argv)).run();
		return 0;
	}
	catch (const Failure& failure)
	{
		std::fprintf(stderr, "viewer: %s\n", failure.what());
		return failure.code;
	}
	catch (const std::exception& error)
	{
		std::fprintf(stderr, "viewer: %s\n", error.what());
		return 4;
	}
}
