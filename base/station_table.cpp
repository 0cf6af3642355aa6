#include "stormcellar/base/station_table.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace stormcellar {
namespace {

// The antenna altitude of a WSR-88D is the sum of the heights of ground, tower and feed horn. For a
// TDWR, it is the site height that the radar writes into message 31. docs/data-sources.md lists the
// sources, checks and doubts of the figures. Keep the rows sorted.
constexpr auto stations = std::to_array<Station>({
    {"KABR", "Aberdeen", "SD", RadarKind::nexrad, 45.45583, -98.41333, 421.5},
    {"KABX", "Albuquerque", "NM", RadarKind::nexrad, 35.14972, -106.82388, 1813.9},
    {"KAKQ", "Norfolk-Richmond", "VA", RadarKind::nexrad, 36.98405, -77.00736, 77.7},
    {"KAMA", "Amarillo", "TX", RadarKind::nexrad, 35.23333, -101.70927, 1128.7},
    {"KAMX", "Miami", "FL", RadarKind::nexrad, 25.61108, -80.41267, 33.8},
    {"KAPX", "Gaylord", "MI", RadarKind::nexrad, 44.90635, -84.71953, 475.8},
    {"KARX", "La Crosse", "WI", RadarKind::nexrad, 43.82278, -91.19111, 413.6},
    {"KATX", "Seattle-Tacoma", "WA", RadarKind::nexrad, 48.19461, -122.49569, 195.7},
    {"KBBX", "Beale AFB", "CA", RadarKind::nexrad, 39.49564, -121.63161, 67.4},
    {"KBGM", "Binghamton", "NY", RadarKind::nexrad, 42.19969, -75.98472, 519.1},
    {"KBHX", "Eureka", "CA", RadarKind::nexrad, 40.49858, -124.29216, 766.9},
    {"KBIS", "Bismarck", "ND", RadarKind::nexrad, 46.77083, -100.76055, 534.9},
    {"KBLX", "Billings", "MT", RadarKind::nexrad, 45.85378, -108.60680, 1128.7},
    {"KBMX", "Birmingham", "AL", RadarKind::nexrad, 33.17242, -86.77017, 231.3},
    {"KBOX", "Boston", "MA", RadarKind::nexrad, 41.95578, -71.13686, 70.7},
    {"KBRO", "Brownsville", "TX", RadarKind::nexrad, 25.91600, -97.41897, 26.8},
    {"KBUF", "Buffalo", "NY", RadarKind::nexrad, 42.94879, -78.73678, 240.8},
    {"KBYX", "Key West", "FL", RadarKind::nexrad, 24.59750, -81.70317, 27.1},
    {"KCAE", "Columbia", "SC", RadarKind::nexrad, 33.94872, -81.11828, 105.2},
    {"KCBW", "Houlton", "ME", RadarKind::nexrad, 46.03925, -67.80643, 262.1},
    {"KCBX", "Boise", "ID", RadarKind::nexrad, 43.49022, -116.23603, 966.8},
    {"KCCX", "State College", "PA", RadarKind::nexrad, 40.92317, -78.00372, 757.7},
    {"KCLE", "Cleveland", "OH", RadarKind::nexrad, 41.41322, -81.85987, 262.1},
    {"KCLX", "Charleston", "SC", RadarKind::nexrad, 32.65553, -81.04219, 69.8},
    {"KCRI", "Norman (ROC test bed)", "OK", RadarKind::nexrad, 35.23833, -97.46000, 400.8},
    {"KCRP", "Corpus Christi", "TX", RadarKind::nexrad, 27.78402, -97.51125, 43.3},
    {"KCXX", "Burlington", "VT", RadarKind::nexrad, 44.51100, -73.16643, 131.4},
    {"KCYS", "Cheyenne", "WY", RadarKind::nexrad, 41.15192, -104.80603, 1887.6},
    {"KDAX", "Sacramento", "CA", RadarKind::nexrad, 38.50111, -121.67783, 43.9},
    {"KDDC", "Dodge City", "KS", RadarKind::nexrad, 37.76083, -99.96889, 814.1},
    {"KDFX", "Laughlin AFB", "TX", RadarKind::nexrad, 29.27314, -100.28033, 364.5},
    {"KDGX", "Jackson", "MS", RadarKind::nexrad, 32.27994, -89.98444, 185.6},
    {"KDIX", "Mount Holly", "NJ", RadarKind::nexrad, 39.94709, -74.41073, 70.1},
    {"KDLH", "Duluth", "MN", RadarKind::nexrad, 46.83694, -92.20972, 470.0},
    {"KDMX", "Des Moines", "IA", RadarKind::nexrad, 41.73120, -93.72287, 333.8},
    {"KDOX", "Dover AFB", "DE", RadarKind::nexrad, 38.82577, -75.44012, 50.0},
    {"KDTX", "Detroit", "MI", RadarKind::nexrad, 42.70000, -83.47167, 370.6},
    {"KDVN", "Quad Cities", "IA", RadarKind::nexrad, 41.61167, -90.58083, 259.4},
    {"KDYX", "Dyess AFB", "TX", RadarKind::nexrad, 32.53850, -99.25433, 482.2},
    {"KEAX", "Kansas City", "MO", RadarKind::nexrad, 38.81025, -94.26447, 332.8},
    {"KEMX", "Tucson", "AZ", RadarKind::nexrad, 31.89365, -110.63025, 1621.2},
    {"KENX", "Albany", "NY", RadarKind::nexrad, 42.58656, -74.06408, 589.8},
    {"KEOX", "Fort Rucker", "AL", RadarKind::nexrad, 31.46056, -85.45939, 163.7},
    {"KEPZ", "El Paso", "NM", RadarKind::nexrad, 31.87306, -106.69800, 1285.6},
    {"KESX", "Las Vegas", "NV", RadarKind::nexrad, 35.70135, -114.89165, 1508.2},
    {"KEVX", "Eglin AFB", "FL", RadarKind::nexrad, 30.56503, -85.92167, 67.4},
    {"KEWX", "Austin-San Antonio", "TX", RadarKind::nexrad, 29.70406, -98.02861, 233.8},
    {"KEYX", "Edwards AFB", "CA", RadarKind::nexrad, 35.09785, -117.56075, 875.7},
    {"KFCX", "Roanoke", "VA", RadarKind::nexrad, 37.02440, -80.27397, 903.7},
    {"KFDR", "Altus AFB", "OK", RadarKind::nexrad, 34.36219, -98.97667, 400.8},
    {"KFDX", "Cannon AFB", "NM", RadarKind::nexrad, 34.63417, -103.61888, 1432.0},
    {"KFFC", "Atlanta", "GA", RadarKind::nexrad, 33.36355, -84.56595, 296.3},
    {"KFSD", "Sioux Falls", "SD", RadarKind::nexrad, 43.58778, -96.72944, 455.7},
    {"KFSX", "Flagstaff", "AZ", RadarKind::nexrad, 34.57433, -111.19844, 2290.3},
    {"KFTG", "Denver", "CO", RadarKind::nexrad, 39.78664, -104.54580, 1710.2},
    {"KFWS", "Dallas-Fort Worth", "TX", RadarKind::nexrad, 32.57300, -97.30315, 236.8},
    {"KGGW", "Glasgow", "MT", RadarKind::nexrad, 48.20636, -106.62469, 726.6},
    {"KGJX", "Grand Junction", "CO", RadarKind::nexrad, 39.06217, -108.21376, 3078.8},
    {"KGLD", "Goodland", "KS", RadarKind::nexrad, 39.36694, -101.70027, 1132.6},
    {"KGRB", "Green Bay", "WI", RadarKind::nexrad, 44.49863, -88.11111, 250.9},
    {"KGRK", "Fort Hood", "TX", RadarKind::nexrad, 30.72183, -97.38294, 183.8},
    {"KGRR", "Grand Rapids", "MI", RadarKind::nexrad, 42.89389, -85.54489, 266.7},
    {"KGSP", "Greenville-Spartanburg", "SC", RadarKind::nexrad, 34.88331, -82.21983, 325.8},
    {"KGWX", "Columbus AFB", "MS", RadarKind::nexrad, 33.89692, -88.32919, 179.8},
    {"KGYX", "Portland", "ME", RadarKind::nexrad, 43.89131, -70.25636, 144.5},
    // Replaced KLIX in 2024. HOMR gives the ground, 13.1 m.
    {"KHDC", "New Orleans (Hammond)", "LA", RadarKind::nexrad, 30.51930, -90.40740, 47.0},
    {"KHDX", "Holloman AFB", "NM", RadarKind::nexrad, 33.07700, -106.12003, 1301.5},
    {"KHGX", "Houston", "TX", RadarKind::nexrad, 29.47190, -95.07873, 35.1},
    {"KHNX", "San Joaquin Valley", "CA", RadarKind::nexrad, 36.31418, -119.63213, 103.6},
    {"KHPX", "Fort Campbell", "KY", RadarKind::nexrad, 36.73697, -87.28558, 186.8},
    {"KHTX", "Huntsville-Hytop", "AL", RadarKind::nexrad, 34.93056, -86.08361, 566.6},
    {"KICT", "Wichita", "KS", RadarKind::nexrad, 37.65444, -97.44306, 426.7},
    {"KICX", "Cedar City", "UT", RadarKind::nexrad, 37.59105, -112.86218, 3278.7},
    {"KILN", "Wilmington", "OH", RadarKind::nexrad, 39.42048, -83.82145, 356.6},
    {"KILX", "Lincoln", "IL", RadarKind::nexrad, 40.15050, -89.33679, 222.8},
    {"KIND", "Indianapolis", "IN", RadarKind::nexrad, 39.70750, -86.28028, 270.4},
    {"KINX", "Tulsa", "OK", RadarKind::nexrad, 36.17513, -95.56416, 228.3},
    {"KIWA", "Phoenix", "AZ", RadarKind::nexrad, 33.28923, -111.66991, 434.6},
    {"KIWX", "North Webster", "IN", RadarKind::nexrad, 41.35861, -85.70000, 321.9},
    // Replaced by KDGX in about 2003. Tower height not published: altitude within 10 m.
    {"KJAN", "Jackson (old site)", "MS", RadarKind::nexrad, 32.31778, -90.08000, 115.7},
    {"KJAX", "Jacksonville", "FL", RadarKind::nexrad, 30.48463, -81.70190, 48.8},
    {"KJGX", "Robins AFB", "GA", RadarKind::nexrad, 32.67568, -83.35083, 188.4},
    {"KJKL", "Jackson", "KY", RadarKind::nexrad, 37.59083, -83.31306, 445.3},
    {"KLBB", "Lubbock", "TX", RadarKind::nexrad, 33.65414, -101.81416, 1029.6},
    {"KLCH", "Lake Charles", "LA", RadarKind::nexrad, 30.12531, -93.21589, 41.8},
    {"KLGX", "Langley Hill", "WA", RadarKind::nexrad, 47.11694, -124.10666, 111.6},
    // Closed in November 2023, replaced by KHDC.
    {"KLIX", "New Orleans (Slidell)", "LA", RadarKind::nexrad, 30.33667, -89.82542, 54.6},
    {"KLNX", "North Platte", "NE", RadarKind::nexrad, 41.95794, -100.57622, 948.8},
    {"KLOT", "Chicago", "IL", RadarKind::nexrad, 41.60444, -88.08444, 231.6},
    {"KLRX", "Elko", "NV", RadarKind::nexrad, 40.73955, -116.80270, 2101.6},
    {"KLSX", "St. Louis", "MO", RadarKind::nexrad, 38.69861, -90.68278, 220.1},
    {"KLTX", "Wilmington", "NC", RadarKind::nexrad, 33.98915, -78.42911, 44.2},
    {"KLVX", "Louisville", "KY", RadarKind::nexrad, 37.97528, -85.94389, 253.9},
    {"KLWX", "Sterling", "VA", RadarKind::nexrad, 38.97611, -77.48750, 123.1},
    {"KLZK", "Little Rock", "AR", RadarKind::nexrad, 34.83650, -92.26219, 197.8},
    {"KMAF", "Midland-Odessa", "TX", RadarKind::nexrad, 31.94346, -102.18925, 902.8},
    {"KMAX", "Medford", "OR", RadarKind::nexrad, 42.08117, -122.71736, 2304.6},
    {"KMBX", "Minot AFB", "ND", RadarKind::nexrad, 48.39306, -100.86444, 484.6},
    {"KMHX", "Morehead City", "NC", RadarKind::nexrad, 34.77591, -76.87619, 44.2},
    {"KMKX", "Milwaukee", "WI", RadarKind::nexrad, 42.96790, -88.55067, 311.8},
    {"KMLB", "Melbourne", "FL", RadarKind::nexrad, 28.11319, -80.65408, 45.4},
    {"KMOB", "Mobile", "AL", RadarKind::nexrad, 30.67944, -88.24000, 88.1},
    {"KMPX", "Minneapolis-St. Paul", "MN", RadarKind::nexrad, 44.84889, -93.56553, 335.6},
    {"KMQT", "Marquette", "MI", RadarKind::nexrad, 46.53111, -87.54833, 464.8},
    {"KMRX", "Knoxville", "TN", RadarKind::nexrad, 36.16861, -83.40194, 437.1},
    {"KMSX", "Missoula", "MT", RadarKind::nexrad, 47.04100, -113.98622, 2431.7},
    {"KMTX", "Salt Lake City", "UT", RadarKind::nexrad, 41.26278, -112.44777, 2009.9},
    {"KMUX", "San Francisco", "CA", RadarKind::nexrad, 37.15522, -121.89844, 1082.0},
    {"KMVX", "Grand Forks", "ND", RadarKind::nexrad, 47.52778, -97.32556, 330.1},
    {"KMXX", "Maxwell AFB", "AL", RadarKind::nexrad, 32.53665, -85.78975, 170.7},
    {"KNKX", "San Diego", "CA", RadarKind::nexrad, 32.91902, -117.04180, 320.6},
    {"KNQA", "Memphis", "TN", RadarKind::nexrad, 35.34472, -89.87333, 132.6},
    {"KOAX", "Omaha", "NE", RadarKind::nexrad, 41.32037, -96.36682, 384.7},
    {"KOHX", "Nashville", "TN", RadarKind::nexrad, 36.24722, -86.56250, 206.0},
    {"KOKX", "New York City", "NY", RadarKind::nexrad, 40.86553, -72.86392, 60.7},
    {"KOTX", "Spokane", "WA", RadarKind::nexrad, 47.68042, -117.62677, 746.5},
    {"KOUN", "Norman (NSSL)", "OK", RadarKind::nexrad, 35.23606, -97.46235, 391.4},
    {"KPAH", "Paducah", "KY", RadarKind::nexrad, 37.06833, -88.77194, 154.2},
    {"KPBZ", "Pittsburgh", "PA", RadarKind::nexrad, 40.53172, -80.21797, 385.9},
    {"KPDT", "Pendleton", "OR", RadarKind::nexrad, 45.69065, -118.85293, 481.6},
    {"KPOE", "Fort Polk", "LA", RadarKind::nexrad, 31.15528, -92.97611, 144.2},
    {"KPUX", "Pueblo", "CO", RadarKind::nexrad, 38.45955, -104.18135, 1634.6},
    {"KRAX", "Raleigh-Durham", "NC", RadarKind::nexrad, 35.66552, -78.48975, 140.8},
    {"KRGX", "Reno", "NV", RadarKind::nexrad, 39.75406, -119.46202, 2559.1},
    {"KRIW", "Riverton", "WY", RadarKind::nexrad, 43.06609, -108.47730, 1716.9},
    {"KRLX", "Charleston", "WV", RadarKind::nexrad, 38.31111, -81.72278, 369.7},
    // Retired. Tower height not published: altitude within 10 m.
    {"KRMX", "Griffiss AFB", "NY", RadarKind::nexrad, 43.46778, -75.45806, 486.7},
    {"KRTX", "Portland", "OR", RadarKind::nexrad, 45.71504, -122.96500, 526.7},
    {"KSFX", "Pocatello", "ID", RadarKind::nexrad, 43.10560, -112.68613, 1383.5},
    {"KSGF", "Springfield", "MO", RadarKind::nexrad, 37.23524, -93.40042, 419.1},
    {"KSHV", "Shreveport", "LA", RadarKind::nexrad, 32.45083, -93.84125, 118.0},
    {"KSJT", "San Angelo", "TX", RadarKind::nexrad, 31.37128, -100.49250, 610.8},
    {"KSOX", "Santa Ana Mountains", "CA", RadarKind::nexrad, 33.81773, -117.63600, 946.7},
    {"KSRX", "Fort Smith", "AR", RadarKind::nexrad, 35.29042, -94.36189, 224.6},
    {"KTBW", "Tampa Bay", "FL", RadarKind::nexrad, 27.70550, -82.40178, 37.2},
    {"KTFX", "Great Falls", "MT", RadarKind::nexrad, 47.45958, -111.38533, 1159.8},
    {"KTLH", "Tallahassee", "FL", RadarKind::nexrad, 30.39758, -84.32894, 53.9},
    {"KTLX", "Oklahoma City", "OK", RadarKind::nexrad, 35.33336, -97.27776, 389.5},
    {"KTWX", "Topeka", "KS", RadarKind::nexrad, 38.99695, -96.23255, 431.3},
    {"KTYX", "Fort Drum", "NY", RadarKind::nexrad, 43.75569, -75.67986, 597.4},
    {"KUDX", "Rapid City", "SD", RadarKind::nexrad, 44.12472, -102.83000, 973.8},
    {"KUEX", "Hastings", "NE", RadarKind::nexrad, 40.32083, -98.44194, 627.0},
    {"KVAX", "Moody AFB", "GA", RadarKind::nexrad, 30.89028, -83.00181, 100.6},
    {"KVBX", "Vandenberg AFB", "CA", RadarKind::nexrad, 34.83855, -120.39791, 412.7},
    {"KVNX", "Vance AFB", "OK", RadarKind::nexrad, 36.74062, -98.12772, 383.4},
    {"KVTX", "Los Angeles", "CA", RadarKind::nexrad, 34.41202, -119.17875, 855.6},
    {"KVWX", "Evansville", "IN", RadarKind::nexrad, 38.26025, -87.72453, 190.5},
    {"KYUX", "Yuma", "AZ", RadarKind::nexrad, 32.49528, -114.65671, 72.8},
    // No longer in the NWS list. Altitude from the ground and a nominal tower: within 5 m.
    {"LPLA", "Lajes AB", "Portugal", RadarKind::nexrad, 38.73028, -27.32167, 1040.9},
    {"PABC", "Bethel", "AK", RadarKind::nexrad, 60.79194, -161.87638, 58.8},
    {"PACG", "Biorka Island", "AK", RadarKind::nexrad, 56.85278, -135.52916, 82.9},
    {"PAEC", "Nome", "AK", RadarKind::nexrad, 64.51139, -165.29500, 27.4},
    {"PAHG", "Kenai", "AK", RadarKind::nexrad, 60.72591, -151.35146, 108.5},
    {"PAIH", "Middleton Island", "AK", RadarKind::nexrad, 59.46077, -146.30344, 40.2},
    {"PAKC", "King Salmon", "AK", RadarKind::nexrad, 58.67944, -156.62944, 43.9},
    {"PAPD", "Pedro Dome", "AK", RadarKind::nexrad, 65.03511, -147.50143, 825.1},
    {"PGUA", "Andersen AFB", "GU", RadarKind::nexrad, 13.45583, 144.81111, 117.7},
    {"PHKI", "South Kauai", "HI", RadarKind::nexrad, 21.89389, -159.55250, 103.6},
    {"PHKM", "Kohala", "HI", RadarKind::nexrad, 20.12528, -155.77777, 1208.8},
    {"PHMO", "Molokai", "HI", RadarKind::nexrad, 21.13278, -157.18027, 440.1},
    {"PHWA", "South Hawaii", "HI", RadarKind::nexrad, 19.09500, -155.56888, 445.3},
    {"RKJK", "Kunsan AB", "South Korea", RadarKind::nexrad, 35.92417, 126.62222, 58.5},
    // The radar has been on this hilltop since about 2007. Before, the radar was 36 km away, at
    // 36.9597 127.0183.
    {"RKSG", "Camp Humphreys", "South Korea", RadarKind::nexrad, 37.20757, 127.28556, 463.6},
    // Sources differ by 0.9 km.
    {"RODN", "Kadena AB", "Japan", RadarKind::nexrad, 26.30780, 127.90347, 125.6},
    {"TADW", "Andrews AFB", "MD", RadarKind::tdwr, 38.69500, -76.84500, 104.9},
    {"TATL", "Atlanta", "GA", RadarKind::tdwr, 33.64694, -84.26194, 328.0},
    {"TBNA", "Nashville", "TN", RadarKind::tdwr, 35.98000, -86.66194, 249.0},
    {"TBOS", "Boston", "MA", RadarKind::tdwr, 42.15806, -70.93306, 79.9},
    {"TBWI", "Baltimore/Washington", "MD", RadarKind::tdwr, 39.09000, -76.63000, 91.1},
    {"TCLT", "Charlotte", "NC", RadarKind::tdwr, 35.33694, -80.88500, 264.9},
    {"TCMH", "Columbus", "OH", RadarKind::tdwr, 40.00611, -82.71500, 349.9},
    {"TCVG", "Covington", "KY", RadarKind::tdwr, 38.89806, -84.58000, 321.0},
    {"TDAL", "Dallas Love Field", "TX", RadarKind::tdwr, 32.92611, -96.96806, 189.9},
    {"TDAY", "Dayton", "OH", RadarKind::tdwr, 40.02194, -84.12306, 310.9},
    {"TDCA", "Washington National", "MD", RadarKind::tdwr, 38.75889, -76.96194, 104.9},
    {"TDEN", "Denver", "CO", RadarKind::tdwr, 39.72806, -104.52611, 1738.0},
    {"TDFW", "Dallas-Fort Worth", "TX", RadarKind::tdwr, 33.06500, -96.91806, 178.0},
    {"TDTW", "Detroit", "MI", RadarKind::tdwr, 42.11111, -83.51500, 235.0},
    {"TEWR", "Newark", "NJ", RadarKind::tdwr, 40.59306, -74.27000, 41.1},
    {"TFLL", "Fort Lauderdale", "FL", RadarKind::tdwr, 26.14306, -80.34389, 36.9},
    {"THOU", "Houston Hobby", "TX", RadarKind::tdwr, 29.51611, -95.24194, 36.0},
    {"TIAD", "Washington Dulles", "VA", RadarKind::tdwr, 39.08389, -77.52889, 143.9},
    {"TIAH", "Houston Intercontinental", "TX", RadarKind::tdwr, 30.06500, -95.56694, 77.1},
    {"TICH", "Wichita", "KS", RadarKind::tdwr, 37.50694, -97.43694, 412.1},
    {"TIDS", "Indianapolis", "IN", RadarKind::tdwr, 39.63694, -86.43611, 257.9},
    {"TJFK", "New York City", "NY", RadarKind::tdwr, 40.58889, -73.88111, 34.1},
    {"TJUA", "San Juan", "PR", RadarKind::nexrad, 18.11567, -66.07817, 901.6},
    {"TLAS", "Las Vegas", "NV", RadarKind::tdwr, 36.14389, -115.00694, 627.0},
    {"TLVE", "Cleveland", "OH", RadarKind::tdwr, 41.29000, -82.00806, 284.1},
    {"TMCI", "Kansas City", "MO", RadarKind::tdwr, 39.49806, -94.74194, 331.9},
    {"TMCO", "Orlando", "FL", RadarKind::tdwr, 28.34389, -81.32611, 52.1},
    {"TMDW", "Chicago Midway", "IL", RadarKind::tdwr, 41.65111, -87.73000, 232.9},
    {"TMEM", "Memphis", "MS", RadarKind::tdwr, 34.89611, -89.99306, 146.9},
    {"TMIA", "Miami", "FL", RadarKind::tdwr, 25.75806, -80.49111, 38.1},
    {"TMKE", "Milwaukee", "WI", RadarKind::tdwr, 42.81889, -88.04611, 284.1},
    {"TMSP", "Minneapolis", "MN", RadarKind::tdwr, 44.87111, -92.93306, 342.0},
    {"TMSY", "New Orleans", "LA", RadarKind::tdwr, 30.02194, -90.40306, 29.9},
    {"TOKC", "Oklahoma City", "OK", RadarKind::tdwr, 35.27611, -97.51000, 399.0},
    {"TORD", "Chicago O'Hare", "IL", RadarKind::tdwr, 41.79694, -87.85806, 227.1},
    {"TPBI", "West Palm Beach", "FL", RadarKind::tdwr, 26.68806, -80.27306, 41.1},
    {"TPHL", "Philadelphia", "NJ", RadarKind::tdwr, 39.94889, -75.06889, 46.9},
    {"TPHX", "Phoenix", "AZ", RadarKind::tdwr, 33.42111, -112.16305, 331.9},
    {"TPIT", "Pittsburgh", "PA", RadarKind::tdwr, 40.50111, -80.48611, 422.1},
    {"TRDU", "Raleigh-Durham", "NC", RadarKind::tdwr, 36.00194, -78.69694, 157.0},
    {"TSDF", "Louisville", "KY", RadarKind::tdwr, 38.04611, -85.61000, 223.1},
    {"TSJU", "San Juan", "PR", RadarKind::tdwr, 18.47389, -66.17889, 47.9},
    {"TSLC", "Salt Lake City", "UT", RadarKind::tdwr, 40.96694, -111.93000, 1309.1},
    {"TSTL", "St. Louis", "MO", RadarKind::tdwr, 38.80500, -90.48889, 196.9},
    {"TTPA", "Tampa Bay", "FL", RadarKind::tdwr, 27.86000, -82.51806, 28.0},
    {"TTUL", "Tulsa", "OK", RadarKind::tdwr, 36.07111, -95.82694, 250.9},
});

constexpr bool strictly_sorted() {
    for (std::size_t i = 1; i < stations.size(); ++i) {
        if (stations[i].icao <= stations[i - 1].icao) return false;
    }
    return true;
}
static_assert(strictly_sorted(), "find_station searches by halves");

std::vector<AddedStation>& added() {
    static std::vector<AddedStation> stations_added;
    return stations_added;
}

constexpr bool is_letter(char c) {
    return c >= 'A' && c <= 'Z';
}
constexpr bool is_letter_or_digit(char c) {
    return is_letter(c) || (c >= '0' && c <= '9');
}

constexpr std::size_t icao_letters = 4;

std::string_view without_number_of_ncei(std::string_view name) {
    constexpr std::string_view of_ncei = "6500";
    if (name.starts_with(of_ncei)) name.remove_prefix(of_ncei.size());
    return name;
}

// Returns the name of the known station at the start of a text, or an empty text.
std::string known_at_start(std::string_view text) {
    const auto icao = icao_of(text.substr(0, icao_letters));
    return icao && find_station(*icao) ? *icao : std::string{};
}

// Returns the name of a known station if the word is this name, or is this name and then a digit.
// Otherwise returns an empty text.
std::string known_in_word(std::string_view word) {
    word = without_number_of_ncei(word);
    const bool goes_on = word.size() > icao_letters;
    if (goes_on && (word[icao_letters] < '0' || word[icao_letters] > '9')) return {};
    return known_at_start(word);
}

}  // namespace

std::span<const Station> all_stations() {
    return stations;
}

std::optional<Station> find_station(std::string_view icao) {
    const auto listed = std::ranges::lower_bound(stations, icao, {}, &Station::icao);
    const bool is_listed = listed != stations.end() && listed->icao == icao;
    for (const AddedStation& one : added()) {
        if (one.icao != icao || (is_listed && !one.instead_of_table)) continue;
        return Station{one.icao,
                       one.name,
                       "",
                       RadarKind::nexrad,
                       one.latitude_deg,
                       one.longitude_deg,
                       one.antenna_altitude_m};
    }
    if (!is_listed) return std::nullopt;
    return *listed;
}

std::string station_in_name(std::string_view file_name) {
    std::string found = known_at_start(without_number_of_ncei(file_name));
    if (!found.empty()) return found;
    constexpr std::string_view in_words =
        "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
    while (!file_name.empty()) {
        const std::size_t end = std::min(file_name.find_first_not_of(in_words), file_name.size());
        const std::string named = known_in_word(file_name.substr(0, end));
        if (!named.empty() && !found.empty() && named != found) return {};
        if (!named.empty()) found = named;
        file_name.remove_prefix(std::min(end + 1, file_name.size()));
    }
    return found;
}

void set_added_stations(std::vector<AddedStation> stations_to_add) {
    added() = std::move(stations_to_add);
}

bool is_icao(std::string_view text) {
    return text.size() == 4 && is_letter(text.front()) &&
           std::ranges::all_of(text.substr(1), is_letter_or_digit);
}

std::optional<std::string> icao_of(std::string_view text) {
    std::string name{text};
    for (char& c : name) {
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    }
    if (!is_icao(name)) return std::nullopt;
    return name;
}

}  // namespace stormcellar
