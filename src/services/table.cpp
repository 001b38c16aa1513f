#include "services/table.h"
#include "services/services.h"

namespace alpenglow::services {

// Descriptors in the files of their services.
Service ptextureService();

namespace {

constexpr unsigned kAll = kWithoutScene | kSendsNothing | kAsksNoLight, kQuiet = kSendsNothing | kAsksNoLight;

void callRayInfo(Services&, const ServiceCall& c) { answerRay(c); }
void callGetvar(Services&, const ServiceCall& c) { answerPrimitiveVariable(c); }
void callLightSetup(Services& s, const ServiceCall& c) { s.lightSetup(c.c, c.site, c.first, c.lanes, c.in); }
void callLightHandles(Services& s, const ServiceCall& c) { s.lightHandles(c); }
void callDepth(Services& s, const ServiceCall& c) { s.answerDepth(c); }
void callRandom(Services& s, const ServiceCall& c) { s.drawRandom(c); }
void callTransform(Services& s, const ServiceCall& c) { s.transformBetween(c); }

} // namespace

ServiceTable serviceTable() {
    static const Service kTable[] = {
        {"texture", SiteKind::Texture, kAll, answerTexture, bindMap},
        {"environment", SiteKind::Environment, kAll, answerTexture, bindMap}, // of maps; with rays it is a trace()
        {"shadow", SiteKind::Shadow, kWithoutScene | kSendsNothing, answerShadow, bindMap},
        {"textureinfo", SiteKind::TextureInfo, kAll, answerTextureInfo},
        ptextureService(),
        {"bake", SiteKind::Bake, 0, answerBake, bindCloud},
        {"bake3d", SiteKind::Bake3d, 0, answerBake, bindCloud},
        {"texture3d", SiteKind::Texture3d, kWithoutScene | kSendsNothing, answerTexture3d, bindCloud},
        {"photonmap", SiteKind::Photons, 0, answerPhotons, bindPhotonMap},
        {"caustic", SiteKind::Photons, 0, answerPhotons, bindPhotonMap},
        {"__skysample", SiteKind::SkySamples, kWithoutScene, answerSky},
        {"__skydensity", SiteKind::SkySamples, kWithoutScene, answerSky},
        {"surface", SiteKind::Message, kSendsNothing, answerMessage},
        {"displacement", SiteKind::Message, kSendsNothing, answerMessage},
        {"atmosphere", SiteKind::Message, kSendsNothing, answerMessage},
        {"incident", SiteKind::Message, kSendsNothing, answerMessage},
        {"opposite", SiteKind::Message, kSendsNothing, answerMessage},
        {"lightsource", SiteKind::LightSource, kSendsNothing, answerLightSource},
        {"attribute", SiteKind::Attribute, kQuiet, answerAttribute},
        {"option", SiteKind::Option, kQuiet, answerOption},
        {"shadername", SiteKind::ShaderName, kQuiet, answerShaderName},
        {"getvar", SiteKind::PrimitiveVariable, kQuiet, callGetvar},
        {"rendererinfo", SiteKind::RendererInfo, kAll, callRayInfo},
        {"rayinfo", SiteKind::RayInfo, kAll, callRayInfo},
        {"raylevel", SiteKind::RayLevel, kAll, callRayInfo},
        {"isindirectray", SiteKind::RayLevel, kAll, callRayInfo},
        {"isshadowray", SiteKind::RayLevel, kAll, callRayInfo},
        {"lightsetup", SiteKind::LightSetup, kSendsNothing, callLightSetup},
        {"getlight", SiteKind::LightHandles, kSendsNothing, callLightHandles},
        {"getlights", SiteKind::LightHandles, kSendsNothing, callLightHandles},
        {"islightcategory", SiteKind::LightHandles, kSendsNothing, callLightHandles},
        {"currentlight", SiteKind::LightHandles, kSendsNothing, callLightHandles},
        {"lightcall", SiteKind::LightHandles, kSendsNothing, callLightHandles},
        {"lightparameter", SiteKind::LightHandles, kSendsNothing, callLightHandles},
        {"depth", SiteKind::Depth, kQuiet, callDepth},
        {"random", SiteKind::Random, kQuiet, callRandom},
        {"transform", SiteKind::Transform, kQuiet, callTransform},
        {"vtransform", SiteKind::Transform, kQuiet, callTransform},
        {"ntransform", SiteKind::Transform, kQuiet, callTransform},
        {"mtransform", SiteKind::Transform, kQuiet, callTransform},
    };
    return kTable;
}

} // namespace alpenglow::services
