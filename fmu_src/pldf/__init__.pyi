from .analysis.analysis import Analysis as Analysis
from .api import analyse as analyse
from .api import base_profile as base_profile
from .api import drive as drive
from .api import learn as learn
from .api import replay as replay
from .api import run_study as run_study
from .cosim.master import Drive as Drive
from .errors import ModelError as ModelError
from .profiles.single_file import read_profile as read_profile
from .profiles.single_file import write_profile as write_profile
from .profiles.store import StoredProfile as StoredProfile
from .recordings.offline import Learned as Learned
from .recordings.recording import Recording as Recording
from .recordings.recording import read_recording as read_recording
from .recordings.replayed import Replay as Replay
from .roads import Route as Route
from .roads import open_route as open_route

__version__: str
