// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 6: what the command lines of curtain_batch and curtain_export share.
#pragma once

#include <string>

namespace curtain_batch {

/// The number that all of a text is; NaN: it is none.
double numberOf(const std::string& text);

/// An output must have a folder to lie in and not be one itself, before anything is written. Throws
/// std::invalid_argument naming the option.
void checkOutput(const std::string& option, const std::string& path);

}  // namespace curtain_batch
