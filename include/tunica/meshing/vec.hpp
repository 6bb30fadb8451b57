// SPDX-License-Identifier: MIT
// The plain functions of points, under the name by which meshing knows them.
#pragma once

#include "tunica/core/vec.hpp"
