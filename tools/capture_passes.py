#!/usr/bin/env python3
"""Prints the labels of a RenderDoc capture, nested and in order: what an update of the light consists of.

    /usr/bin/python3 tools/capture_passes.py FILE.rdc [--unnamed]

What repeats is printed once, with how often. --unnamed lists the Vulkan objects that have no name instead. Nothing is
replayed, so no device is needed. Needs the package python3-renderdoc.
"""
import argparse
import sys

try:
    import renderdoc
except ImportError:
    sys.exit('capture_passes: there is no module renderdoc; install python3-renderdoc and use /usr/bin/python3')


class Label:
    def __init__(self, name):
        self.name = name
        self.within = []

    def __eq__(self, other):
        return (self.name, self.within) == (other.name, other.within)


def open_label(parent, name):
    """Frames follow each other under the same labels: those are one. Passes, which hold no label, are not."""
    last = parent.within[-1] if parent.within else None
    if last is not None and last.name == name and last.within:
        return last
    parent.within.append(Label(name))
    return parent.within[-1]


def labels_of(chunks):
    """A capture's commands stand in the order in which they were recorded."""
    root = Label('')
    path = [root]
    for chunk in chunks:
        if chunk.name == 'vkCmdBeginDebugUtilsLabelEXT':
            path.append(open_label(path[-1], chunk.FindChildRecursively('pLabelName').AsString()))
        elif chunk.name == 'vkCmdEndDebugUtilsLabelEXT':
            path.pop()
    return root


def folded(labels):
    """What repeats: (labels, how often). Of several ways the one that takes in most."""
    at = 0
    while at < len(labels):
        length, times = 1, 1
        for candidate in range(1, (len(labels) - at) // 2 + 1):
            run = labels[at : at + candidate]
            repeats = 1
            while labels[at + repeats * candidate : at + (repeats + 1) * candidate] == run:
                repeats += 1
            if repeats > 1 and repeats * candidate > length * times:
                length, times = candidate, repeats
        yield labels[at : at + length], times
        at += length * times


def show(labels, indent=''):
    for run, times in folded(labels):
        if len(run) > 1:
            print(f'{indent}{times} times')
            show(run, indent + '  ')
            continue
        print(indent + run[0].name + (f' x {times}' if times > 1 else ''))
        show(run[0].within, indent + '  ')


def unnamed(chunks):
    """Calls that made an object which no other call names. An instance cannot have a name."""
    made = {}
    for chunk in chunks:
        if chunk.name == 'vkSetDebugUtilsObjectNameEXT':
            made.pop(str(chunk.FindChild('Object').AsResourceId()), None)
        elif chunk.name.startswith(('vkCreate', 'vkAllocate', 'vkGetDeviceQueue')) and chunk.name != 'vkCreateInstance':
            children = [chunk.GetChild(n) for n in range(chunk.NumChildren())]
            handles = [child for child in children if child.type.basetype == renderdoc.SDBasic.Resource]
            made[str(handles[-1].AsResourceId())] = chunk.name
    return made


def main():
    parser = argparse.ArgumentParser(description='Prints the labels of a RenderDoc capture, nested and in order.')
    parser.add_argument('capture', metavar='FILE.rdc')
    parser.add_argument('--unnamed', action='store_true', help='list the Vulkan objects without a name instead')
    arguments = parser.parse_args()
    capture = renderdoc.OpenCaptureFile()
    opened = capture.OpenFile(arguments.capture, 'rdc', None)
    if opened != renderdoc.ResultCode.Succeeded:
        sys.exit(f'capture_passes: {arguments.capture} cannot be read as a capture: {opened}')
    chunks = capture.GetStructuredData().chunks
    if len(chunks) == 0:
        sys.exit(f'capture_passes: {arguments.capture} holds no calls: is it a capture?')
    if arguments.unnamed:
        for handle, call in unnamed(chunks).items():
            print(f'{handle} of {call}')
    else:
        show(labels_of(chunks).within)
    capture.Shutdown()


if __name__ == '__main__':
    main()
