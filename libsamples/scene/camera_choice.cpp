// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/camera_choice.h"
