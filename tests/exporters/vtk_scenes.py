"""vtk_scenes.py OUT: six scenes of VTK as NAME.png, drawn by VTK itself, and NAME.rib, by its vtkRIBExporter. Run with a display."""
import os
import sys

import vtk

SIZE = 200


def actor(source, colour=(1, 1, 1), specular=0.0, opacity=1.0, normals=False):
    """Ambient 0 and diffuse 1, as VTK has them without being asked."""
    last = source
    if normals:
        last = vtk.vtkPolyDataNormals()
        last.SetInputConnection(source.GetOutputPort())
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(last.GetOutputPort())
    mapper.ScalarVisibilityOff()
    a = vtk.vtkActor()
    a.SetMapper(mapper)
    p = a.GetProperty()
    p.SetColor(*colour)
    p.SetSpecular(specular)
    p.SetSpecularPower(20)
    p.SetOpacity(opacity)
    return a


def sphere(resolution=48, radius=.5):
    s = vtk.vtkSphereSource()
    s.SetRadius(radius)
    s.SetThetaResolution(resolution)
    s.SetPhiResolution(resolution)
    return s


def ball(add):
    add(actor(sphere(), (.9, .4, .2)))


def shine(add):
    add(actor(sphere(), (.2, .4, .9), specular=.6))


def shapes(add):
    cone, cube, cylinder = vtk.vtkConeSource(), vtk.vtkCubeSource(), vtk.vtkCylinderSource()
    cone.SetResolution(24)
    cylinder.SetResolution(24)
    for i, (source, colour) in enumerate(((cone, (1, .8, .2)), (cube, (.3, .8, .4)), (cylinder, (.5, .4, .9)))):
        a = actor(source, colour)
        a.SetPosition(1.3 * (i - 1), 0, 0)
        a.RotateX(20)
        a.RotateY(30)
        add(a)


def heights(add):
    """Colours of points."""
    source = sphere()
    source.Update()
    data, colours = source.GetOutput(), vtk.vtkUnsignedCharArray()
    colours.SetNumberOfComponents(3)
    for i in range(data.GetNumberOfPoints()):
        t = data.GetPoint(i)[1] + .5
        colours.InsertNextTuple3(255 * t, 200 * (1 - t), 128)
    data.GetPointData().SetScalars(colours)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    a = vtk.vtkActor()
    a.SetMapper(mapper)
    add(a)


def glassy(add):
    add(actor(sphere(24, .3), (1, .3, .3)))
    outer = vtk.vtkCubeSource()
    a = actor(outer, (.4, .6, 1), opacity=.4)
    a.RotateY(30)
    add(a)


def contour(add):
    """An isosurface of a quadric, with normals."""
    quadric, sample, iso = vtk.vtkQuadric(), vtk.vtkSampleFunction(), vtk.vtkContourFilter()
    quadric.SetCoefficients(.5, 1, .2, 0, .1, 0, 0, .2, 0, 0)
    sample.SetSampleDimensions(40, 40, 40)
    sample.SetImplicitFunction(quadric)
    iso.SetInputConnection(sample.GetOutputPort())
    iso.GenerateValues(3, .1, .7)
    add(actor(iso, (.8, .8, .7)))


def main(out):
    for make in (ball, shine, shapes, heights, glassy, contour):
        window, renderer = vtk.vtkRenderWindow(), vtk.vtkRenderer()
        window.SetOffScreenRendering(1)
        window.SetSize(SIZE, SIZE)
        window.SetMultiSamples(8)
        window.AddRenderer(renderer)
        renderer.SetBackground(.1, .1, .2)
        make(renderer.AddActor)
        light = vtk.vtkLight()
        light.SetPosition(3, 4, 6)
        light.SetFocalPoint(0, 0, 0)
        renderer.AddLight(light)
        renderer.ResetCamera()
        window.Render()
        grab, writer = vtk.vtkWindowToImageFilter(), vtk.vtkPNGWriter()
        grab.SetInput(window)
        grab.ReadFrontBufferOff()
        writer.SetInputConnection(grab.GetOutputPort())
        writer.SetFileName(os.path.join(out, make.__name__ + ".png"))
        writer.Write()
        exporter = vtk.vtkRIBExporter()
        exporter.SetInput(window)
        exporter.SetSize(SIZE, SIZE)
        exporter.SetPixelSamples(4, 4)
        exporter.SetFilePrefix(os.path.join(out, make.__name__))
        exporter.SetTexturePrefix(os.path.join(out, make.__name__))
        exporter.BackgroundOn()
        exporter.Write()


main(sys.argv[1])
