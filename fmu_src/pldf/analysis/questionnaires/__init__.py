"""Questionnaires: what people answered, from the exports of survey tools to scores."""

from .answered import Questionnaire, read_questionnaire
from .scales import LAAN, PROFILE, SCALES
from .survey_map import SurveyMap, survey_map

__all__ = (
    "LAAN",
    "PROFILE",
    "SCALES",
    "Questionnaire",
    "SurveyMap",
    "read_questionnaire",
    "survey_map",
)
