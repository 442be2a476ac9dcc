// SPDX-FileCopyrightText: The Nightcity authors
// SPDX-License-Identifier: Apache-2.0
//
// The number of the triangle.
#version 460

layout(location = 0) flat in uint firstTriangle;
layout(location = 0) out uint triangle;

void main() {
    triangle = firstTriangle + uint(gl_PrimitiveID);
}
