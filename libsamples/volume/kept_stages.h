// SPDX-License-Identifier: GPL-3.0-or-later
// What is kept of stages that parts cannot share out ↔ bytes.
#pragma once

#include "volume/detail_choice.h"
#include "volume/occluders.h"
#include "volume/receivers.h"
#include "volume/trim.h"

#include <string>
#include <string_view>

namespace nook
{

std::string savedDetail(const DetailChoice& choice);

// False where savedDetail() writes no such bytes.
bool loadDetail(std::string_view bytes, DetailChoice& choice);

std::string savedOccluding(const Occluding& found);

// False where savedOccluding() writes no such bytes.
bool loadOccluding(std::string_view bytes, Occluding& found);

std::string savedSides(const ReceiverSides& sides);

// False where savedSides() writes no such bytes.
bool loadSides(std::string_view bytes, ReceiverSides& sides);

// Of trimVolumes(): the reaches of the set's polygons, and the counts.
std::string savedTrim(const VolumeSet& volumes, const TrimCounts& counts);

// False where savedTrim() writes no such bytes of a set with as many polygons: then nothing of it has changed.
bool loadTrim(std::string_view bytes, VolumeSet& volumes, TrimCounts& counts);

} // namespace nook
