#!/usr/bin/env python3
# Writes an archive, reads it in a scene that has inline archives and verbatim requests.
import prman

ri = prman.Ri()
ri.Option("rib", {"string asciistyle": "indented"})
ri.Begin("written_part.rib")
ri.AttributeBegin()
ri.Color([0, 1, 0])
ri.Torus(1, 0.3, 0, 360, 360)
ri.AttributeEnd()
ri.End()

ri.Begin(ri.RENDER)
ri.Option("searchpath", {"string archive": "./:@"})
ri.Display("written.exr", "file", "rgba", {"int asrgba": [1]})
ri.Projection("perspective", {"float fov": 40})
ri.WorldBegin()
ri.Translate(0, 0, 6)
ri.ArchiveBegin("two")
ri.ReadArchive("written_part.rib")
ri.ArchiveEnd()
ri.ReadArchive("two")
ri.ArchiveRecord(ri.VERBATIM, 'Translate 0 1 0\nSphere 0.5 -0.5 0.5 360\n')
ri.WorldEnd()
ri.End()
