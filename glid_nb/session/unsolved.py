"""Solve the unsolved poses of a document."""

from collections.abc import Callable
from dataclasses import replace

from glid_nb.session.document import Document, DocumentError, NamedPose, Solution
from glid_nb.session.live_solver import solve_edited


def solved_document(
    document: Document, progress: Callable[[str], None] = lambda _: None
) -> Document:
    """The document with every pose solved on its cage; itself if all poses are solved already.

    ``progress`` is called with the name of each pose before it is solved. Raises a DocumentError
    that names all unsolved poses whose methods give no certified map.
    """
    mesh = [repr(p.name) for p in document.unsolved if not p.method.certified]
    if mesh:
        what = "not solved, and their methods give no certified maps"
        advice = "open the session and choose other methods"
        raise DocumentError(f"these poses are {what}: {', '.join(mesh)}; {advice}")
    if not document.unsolved:
        return document

    def solved(poses: tuple[NamedPose, ...]) -> tuple[NamedPose, ...]:
        done = list(poses)
        for i, pose in enumerate(poses):
            if pose.unsolved:
                progress(pose.name)
                done[i] = _solved(pose)
        return tuple(done)

    if not document.parts:
        return replace(document, poses=solved(document.poses))
    parts = tuple(replace(part, poses=solved(part.poses)) for part in document.parts)
    return replace(document, poses=parts[document.part].poses, parts=parts)


def _solved(pose: NamedPose) -> NamedPose:
    result = solve_edited(pose, lambda _: False)
    solution = Solution(result.status, result.message, result.history, (1,))
    return replace(pose, map=result.map, solution=solution)
