folder_library(world DEPS bsdf lanes pointcloud photonmap ptex shading)
