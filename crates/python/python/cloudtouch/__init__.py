"""How likely is it that the surfaces behind two noisy point clouds, or a cloud and a mesh, touch?

Metres and radians everywhere. A body is in the frame of its own points; a pose is the 4 x 4 matrix that maps the
frame of the second body into that of the first: ``p_a = (pose @ [x, y, z, 1])[:3]``.

>>> import cloudtouch as ct
>>> query = ct.Query(accept=0.9, reject=0.1)

See ``Cloud``, ``Mesh`` and ``Query``; ``python -m cloudtouch.demo`` shows them at work.
"""

from cloudtouch._native import CloudtouchError, __version__
from cloudtouch.bodies import Change, Cloud, Mesh, SeenLink
from cloudtouch.checker import PoseChecker
from cloudtouch.motion import AlongPath, Gradient, Penetration, Swept, UnderPoses
from cloudtouch.page import Page
from cloudtouch.query import Query
from cloudtouch.report import Batch, Contact, Evidence, PointProbabilities, Report, Within
from cloudtouch.robot import Joint, PathChecked, Robot, RobotChecker, Stopped
from cloudtouch.scene import BodyWarning, Checked, Outside, PairAnswer, Scene

__all__ = [
    "AlongPath",
    "Batch",
    "BodyWarning",
    "Change",
    "Checked",
    "Cloud",
    "CloudtouchError",
    "Contact",
    "Evidence",
    "Gradient",
    "Joint",
    "Mesh",
    "Outside",
    "Page",
    "PairAnswer",
    "PathChecked",
    "Penetration",
    "PointProbabilities",
    "PoseChecker",
    "Query",
    "Report",
    "Robot",
    "RobotChecker",
    "Scene",
    "SeenLink",
    "Stopped",
    "Swept",
    "UnderPoses",
    "Within",
    "__version__",
]
