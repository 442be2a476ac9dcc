# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
#
# Writes the words of the SPIR-V file INPUT as the array k<Name>Spirv into the
# C++ header OUTPUT. Usage: cmake -DNAME=march -DINPUT=... -DOUTPUT=... -P this
file(READ ${INPUT} hex HEX)
# SPIR-V words are little endian in the file.
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${hex}")
string(REGEX REPLACE "(0x........,0x........,0x........,0x........,)" "\\1\n" words "${words}")
set(camel "")
string(REPLACE "_" ";" parts ${NAME})
foreach(part IN LISTS parts)
    string(SUBSTRING ${part} 0 1 first)
    string(SUBSTRING ${part} 1 -1 rest)
    string(TOUPPER ${first} first)
    string(APPEND camel ${first}${rest})
endforeach()
file(WRITE ${OUTPUT} "// Made from ${NAME}.comp by shaders/cmake/embed_spirv.cmake.
#pragma once

#include <cstdint>

namespace nightcity {

inline constexpr std::uint32_t k${camel}Spirv[] = {
${words}};

}  // namespace nightcity
")
