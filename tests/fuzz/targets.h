// What the list of targets is made of.
#pragma once
#include "fuzz.h"

namespace alpenglow::fuzz {

/// Writes a file in the folder of the input.
void putFile(const std::string& name, const Bytes&);

// Seeds that our own writers make, in the current folder (madeInChild()).
void makePictures();
void makeParts();
void makeClouds(); // maps.cpp
void makePtexFiles();
void makeDeepMaps();
/// Map files that the scenes and shaders of the generators name: a.tx, a.shd.
void putMaps();
/// The scene that parts are of.
extern const char* const partScene;

// What is run. Each reads the input as its name says.
Outcome readRib(const Bytes&);       ///< without rendering
Outcome readModelFile(const Bytes&); ///< .ply or .obj, by its first byte; what comes out must fit together
Outcome renderRib(const Bytes&);     ///< 8 x 6 pixels
Outcome checkShader(const Bytes&);   ///< as far as the checker
Outcome shadeShader(const Bytes&);   ///< over a patch
Outcome shadeInWidths(const Bytes&); ///< the same at 4, 8 and 16 lanes, which must not show
Outcome renderShader(const Bytes&);  ///< in a scene that uses what kinds there are
Outcome evaluate(const Bytes&);      ///< an expression at 4 and 16 lanes
Outcome decodePicture(const Bytes&); ///< and look it up
Outcome usePicture(const Bytes&);    ///< by diff, maketx or a scene
Outcome usePart(const Bytes&);       ///< by merge or --resume
Outcome serveEditor(const Bytes&);   ///< a session of the language server
Outcome commandLine(const Bytes&);   ///< arguments, separated by blanks

// maps.cpp: lookups in them, too.
Outcome readCloud(const Bytes&);
Outcome readBaked(const Bytes&);
Outcome readPtex(const Bytes&);
Outcome readPhotons(const Bytes&);
Bytes summed(Bytes); ///< right check sums of our own formats

} // namespace alpenglow::fuzz
